#include "bench/plot.hpp"

#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>

#include <span>

#include "results/atomic_file.hpp"

namespace drape::bench {
namespace {

/// Text in single quotes, which gnuplot takes as it is.
std::string quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : text) result += c == '\'' ? "''" : std::string(1, c);
  return result + "'";
}

std::string data(const Series& series, std::size_t number) {
  std::string text = fmt::format("$series{} << END\n", number);
  for (std::size_t k = 0; k < series.x.size(); ++k) text += fmt::format("{} {}\n", series.x[k], series.y[k]);
  return text + "END\n";
}

/// Colours that the colour-blind tell apart   [Okabe, Ito 2008].
constexpr const char* colours[] = {"#000000", "#0072B2", "#009E73", "#D55E00", "#CC79A7",
                                   "#E69F00", "#56B4E9", "#888888", "#994F00"};

/// Lines and points differ in colour and shape, so that neither alone is needed to tell them apart.
std::string drawing(const Series& series, std::size_t number) {
  if (!series.joined)
    return fmt::format("$series{} with points pt 7 ps 0.3 lc rgb 'gray60' title {}", number, quoted(series.name));
  return fmt::format("$series{} with linespoints lc rgb '{}' pt {} ps 0.9 lw 1.6 title {}", number,
                     colours[number % std::size(colours)], number + 3, quoted(series.name));
}

std::string script(const Plot& plot, const std::filesystem::path& stem) {
  std::string text, curves;
  for (std::size_t k = 0; k < plot.series.size(); ++k) {
    if (plot.series[k].x.empty()) continue;
    text += data(plot.series[k], k);
    curves += (curves.empty() ? "plot " : ", \\\n     ") + drawing(plot.series[k], k);
  }
  text += fmt::format(
      "set title {} noenhanced\nset xlabel {}\nset ylabel {}\nset logscale xy\nset format '10^{{%L}}'\nset xrange [*:*] "
      "reverse\n"
      "set grid\nset key outside right noenhanced\n",
      quoted(plot.title), quoted(plot.x_title), quoted(plot.y_title));
  if (plot.uncertain_below > 0)
    text +=
        fmt::format("set object 1 rectangle from first {}, graph 0 to graph 1, graph 1 behind fc rgb 'gray85' fs noborder\n",
                    plot.uncertain_below);
  for (const auto& [terminal, ending] :
       {std::pair{"svg size 900,560 background 'white'", ".svg"}, {"pngcairo size 900,560", ".png"}})
    text += fmt::format("set terminal {}\nset output {}\n{}\n", terminal, quoted(stem.string() + ending), curves);
  return text;
}

/// The exit code of gnuplot, or 127 if it cannot be started, as in a shell.
int run_gnuplot(const std::string& file) {
  std::string program = "gnuplot", argument = file;
  char* arguments[] = {program.data(), argument.data(), nullptr};
  pid_t child = 0;
  if (posix_spawnp(&child, program.c_str(), nullptr, nullptr, arguments, environ) != 0) return 127;
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace

std::string draw(const Plot& plot, const std::filesystem::path& stem) {
  const std::string file = stem.string() + ".gp";
  const std::string text = script(plot, stem);
  results::publish(file, std::as_bytes(std::span(text)), results::Existing::replace);
  switch (run_gnuplot(file)) {
    case 0: return "";
    case 127: return fmt::format("{} is not drawn: gnuplot is missing (Debian package gnuplot-nox)", stem.string());
    default: return fmt::format("{} is not drawn: gnuplot failed on {}", stem.string(), file);
  }
}

}  // namespace drape::bench
