#include "bench/commands/command_line.hpp"

int main(int argc, char** argv) { return drape::bench::run_command_line(argc, argv); }
