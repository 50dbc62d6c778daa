// bench/cluster on this machine: GNU parallel, and a Slurm of its own with one node; a shard, and the node, are killed in the
// middle.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <optional>
#include <string>
#include <thread>

#include "results/file/journal.hpp"
#include "solver/base/descriptor.hpp"
#include "solver/base/temporary.hpp"
#include "verify/support/all_but_times.hpp"
#include "verify/support/bench_integrators.hpp"
#include "verify/support/slow.hpp"

namespace drape::verify::cluster_test {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;
using testing::HasSubstr;

/// Nine checkpoints in a second, so that there is time to kill a process between two of them.
const Words sweep{"study", "figure-3.2", "--quick"};

std::string content(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

bool comes_true(const std::function<bool()>& condition, std::chrono::milliseconds within = 30s) {
  for (const auto end = std::chrono::steady_clock::now() + within; std::chrono::steady_clock::now() < end;) {
    if (condition()) return true;
    std::this_thread::sleep_for(10ms);
  }
  return false;
}

/// The process of a shard in a folder.
std::optional<pid_t> process_of(const std::string& share, const fs::path& folder) {
  std::error_code gone;
  for (const auto& entry : fs::directory_iterator("/proc", gone)) {
    const std::string name = entry.path().filename();
    if (name.find_first_not_of("0123456789") != std::string::npos) continue;
    const std::string arguments = content(entry.path() / "cmdline");
    if (arguments.starts_with(DRAPE_BENCH_INTEGRATORS) && arguments.find('\0' + share + '\0') != std::string::npos &&
        fs::read_symlink(entry.path() / "cwd", gone) == folder)
      return std::stoi(name);
  }
  return std::nullopt;
}

/// Whether a shard has computed something, beside noting where it comes from.
bool has_begun(const BenchIntegrators& program, const std::string& journal) {
  const fs::path path = program.folder() / journal;
  return fs::exists(path) && results::read_journal(path).entries.size() > 1;
}

Command cluster(const BenchIntegrators& program, const Words& arguments, const Words& environment = {}) {
  Command command = program.command(arguments + sweep + Words{"--out", "a.h5"});
  command.program = fs::path(DRAPE_SOURCE_DIR) / "bench/cluster";
  command.environment.push_back(std::string("DRAPE_PROGRAM=") + DRAPE_BENCH_INTEGRATORS);
  command.environment.insert(command.environment.end(), environment.begin(), environment.end());
  return command;
}

void expect_result(const BenchIntegrators& program, const ProgramResult& result) {
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("recorded in a.h5"));
  EXPECT_THAT(result.out, HasSubstr("report: a-report/index.html"));
  program.output(sweep + Words{"--out", "whole.h5"});
  EXPECT_EQ(all_but_times(program.folder() / "a.h5"), all_but_times(program.folder() / "whole.h5"));
}

/// How often shards were started.
std::ptrdiff_t rounds(const ProgramResult& result) {
  return std::ranges::count_if(lines(result.err), [](const std::string& line) { return line.ends_with(" of 2"); });
}

bool is_there(const char* name) {
  for (const std::string& folder : split(std::getenv("PATH"), ':') + Words{"/usr/sbin"})
    if (fs::exists(fs::path(folder) / name)) return true;
  return false;
}

TEST(Cluster, OnThisMachineStartsAKilledShardAgain) {
  DRAPE_SLOW();
  if (!is_there("parallel")) GTEST_SKIP() << "needs the Debian package parallel";
  const BenchIntegrators program;
  RunningProgram running(cluster(program, {"--local", "2"}));
  std::optional<pid_t> process;
  ASSERT_TRUE(comes_true([&] {
    return has_begun(program, "a.h5.shard-2-of-2.journal") && (process = process_of("2/2", program.folder())).has_value();
  }));
  ASSERT_EQ(kill(*process, SIGKILL), 0);
  const ProgramResult result = running.wait();
  expect_result(program, result);
  EXPECT_GE(rounds(result), 2);
}

/// Ports that were free a moment ago.
std::array<int, 2> free_ports() {
  std::array<int, 2> ports{};
  const base::Descriptor sockets[]{base::Descriptor(socket(AF_INET, SOCK_STREAM, 0)),
                                   base::Descriptor(socket(AF_INET, SOCK_STREAM, 0))};
  for (std::size_t k = 0; k < ports.size(); ++k) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    auto* const any = reinterpret_cast<sockaddr*>(&address);  // NOLINT
    if (bind(sockets[k].fd, any, size) != 0 || getsockname(sockets[k].fd, any, &size) != 0) return {};
    ports[k] = ntohs(address.sin_port);
  }
  return ports;
}

/// A cluster of this machine alone, which needs root: the controller of Slurm, and a node in a namespace of its own, so that it
/// can be killed with all that runs on it. Nothing of it is in the system's places.
class SlurmCluster {
 public:
  SlurmCluster() {
    const auto [controller_port, node_port] = free_ports();
    std::array<char, 256> host{};
    gethostname(host.data(), host.size() - 1);
    const std::string name = std::string(host.data()).substr(0, std::string(host.data()).find('.'));
    const auto path = [&](const char* file) { return (folder_ / file).string(); };
    fs::create_directory(folder_ / "state");
    fs::create_directory(folder_ / "spool");
    std::ofstream(folder_ / "slurm.conf")
        << fmt::format(
               "ClusterName=test\nSlurmctldHost={}(127.0.0.1)\nSlurmUser=root\nAuthType=auth/none\nCredType=cred/none\n", name)
        << fmt::format("SlurmctldPort={}\nSlurmdPort={}\n", controller_port, node_port)
        << fmt::format("StateSaveLocation={}\nSlurmdSpoolDir={}\n", path("state"), path("spool"))
        << fmt::format("SlurmctldPidFile={}\nSlurmdPidFile={}\n", path("slurmctld.pid"), path("slurmd.pid"))
        << "SelectType=select/"
           "cons_tres\nSelectTypeParameters=CR_CPU\nSlurmdParameters=config_overrides\nProctrackType=proctrack/"
           "linuxproc\nTaskPlugin=task/"
           "none\nMpiDefault=none\nReturnToService=2\n"
        << "SchedulerParameters=sched_min_interval=0,batch_sched_delay=0,bf_interval=1\n"
        << "MessageTimeout=1\nBatchStartTimeout=1\n"  // so that a job that is gone is noticed after two seconds
        << fmt::format("NodeName={} NodeAddr=127.0.0.1 CPUs=2\nPartitionName=main Nodes=ALL Default=YES\n", name);
    controller_.emplace(daemon("exec slurmctld -D >controller.log 2>&1"));
    start_node();
  }

  void start_node() { node_.emplace(daemon("exec unshare --pid --fork --kill-child --mount-proc slurmd -D >node.log 2>&1")); }

  void kill_node() {
    node_->send(SIGKILL);
    node_->wait();
  }

  std::string setting() const { return "SLURM_CONF=" + (folder_ / "slurm.conf").string(); }
  std::string logs() const { return content(folder_ / "controller.log") + content(folder_ / "node.log"); }

  /// What one of its commands prints.
  std::string answer(const std::string& command) const { return run_program(daemon(command)).out; }

 private:
  Command daemon(const std::string& command) const {
    return {.program = "/bin/sh",
            .arguments = {"-c", "PATH=$PATH:/usr/sbin; " + command},
            .folder = folder_.path(),
            .environment = {setting()},
            .output = {}};
  }

  base::TemporaryFolder folder_;
  std::optional<RunningProgram> controller_, node_;
};

TEST(Cluster, OfSlurmLosesANodeAndGoesOn) {
  DRAPE_SLOW();
  if (!is_there("slurmctld") || !is_there("slurmd")) GTEST_SKIP() << "needs the Debian package slurm-wlm";
  if (geteuid() != 0) GTEST_SKIP() << "needs root, to start a node of Slurm";
  const BenchIntegrators program;
  SlurmCluster slurm;
  ASSERT_TRUE(comes_true([&] { return slurm.answer("sinfo --noheader --format=%T 2>&1") == "idle\n"; })) << slurm.logs();
  RunningProgram running(cluster(program, {"--slurm", "2"}, {slurm.setting()}));
  ASSERT_TRUE(comes_true([&] {
    return has_begun(program, "a.h5.shard-1-of-2.journal") || has_begun(program, "a.h5.shard-2-of-2.journal");
  })) << slurm.logs();
  EXPECT_EQ(slurm.answer("squeue --noheader --array --format=%T | sort | xargs"), "PENDING RUNNING\n") << "one job a node";
  slurm.kill_node();
  std::this_thread::sleep_for(3s);
  slurm.start_node();
  const ProgramResult result = running.wait();
  expect_result(program, result);
  EXPECT_THAT(slurm.logs(), HasSubstr("cancelled by node failure"));
  EXPECT_GE(rounds(result), 2);
}

TEST(Cluster, RefusesWhatItCannotShare) {
  const BenchIntegrators program;
  const auto said = [&](const Words& arguments) {
    Command command = cluster(program, {});
    command.arguments = arguments;
    const ProgramResult result = run_program(command);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_EQ(lines(result.err).size(), 1u);
    return result.err;
  };
  EXPECT_THAT(said({}), HasSubstr("expected --local N or --slurm N"));
  EXPECT_THAT(said({"--local", "0", "study", "modes", "--out", "a.h5"}), HasSubstr("--local: '0' is not a number of shards"));
  EXPECT_THAT(said({"--local", "2", "list", "--out", "a.h5"}), HasSubstr("'list' cannot be shared"));
  EXPECT_THAT(said({"--local", "2", "study", "modes"}), HasSubstr("--out is missing"));
  EXPECT_TRUE(program.files().empty());
}

}  // namespace
}  // namespace drape::verify::cluster_test
