// SPDX-License-Identifier: Apache-2.0
// Tests `submit` on a farm: Slurm's own daemons, started here with two nodes on this machine, and a node that dies
// during the work.
#include "tests/cli/program.hpp"

#include "app/process/child_program.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <memory>
#include <random>
#include <set>
#include <stdexcept>
#include <thread>

#include <netinet/in.h>
#include <pwd.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

namespace penumbra::tests {
namespace {

using app::ChildProgram;
using testing::HasSubstr;

/// Returns a port on which nothing listens.
int free_port() {
  const int socket = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof(address);
  const bool bound = ::bind(socket, reinterpret_cast<const sockaddr*>(&address), size) == 0 &&
                     ::getsockname(socket, reinterpret_cast<sockaddr*>(&address), &size) == 0;
  ::close(socket);
  if (!bound) throw std::runtime_error("no free port");
  return ntohs(address.sin_port);
}

std::string file_text(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Returns the running processes for which `wanted` holds, given their folder in /proc.
std::vector<pid_t> processes(const std::function<bool(const std::filesystem::path&)>& wanted) {
  std::vector<pid_t> found;
  for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
    const std::string name = entry.path().filename();
    if (std::ranges::all_of(name, [](char c) { return c >= '0' && c <= '9'; }) && wanted(entry.path()))
      found.push_back(std::stoi(name));
  }
  return found;
}

class FarmSlurmFull : public ProgramTest {
 protected:
  void SetUp() override {
    for (const char* program : {"munged", "slurmctld", "slurmd", "sbatch", "scontrol", "squeue"}) {
      if (app::run_program({"sh", "-c", std::string("PATH=$PATH:/usr/sbin command -v ") + program}).code != 0) {
        GTEST_SKIP() << program
                     << " is not installed, and nothing was tried: apt-get install munge slurmctld slurmd "
                        "slurm-client (packages.txt)";
      }
    }
    scene_ = moving_scene();
    start();
  }
  ~FarmSlurmFull() override {
    if (daemons_.empty()) return;
    (void)slurm({"scancel", "--user=" + user()});
    (void)eventually(30, [&] { return slurm({"squeue", "--noheader"}).empty(); });
    while (!daemons_.empty()) daemons_.pop_back();  // in reverse order: nodes, controller, munge
  }

  static std::string user() { return ::getpwuid(::getuid())->pw_name; }

  /// Starts a daemon, which ends with this test; its output is in the folder.
  void daemon(const std::string& name, std::vector<std::string> command) {
    std::vector<std::string> words = {"sh", "-c", "PATH=$PATH:/usr/sbin; exec \"$@\" >\"$0\" 2>&1",
                                      path(name + ".out")};
    words.insert(words.end(), command.begin(), command.end());
    daemons_.push_back(std::make_unique<ChildProgram>(std::move(words)));
  }

  void start() {
    std::filesystem::permissions(folder_, std::filesystem::perms(0755));  // munge needs no less, Slurm allows no more
    std::string key(1024, '\0');
    std::random_device random;
    for (char& c : key) c = static_cast<char>(random());
    std::filesystem::permissions(write("munge.key", key), std::filesystem::perms::owner_read);
    for (const char* folder : {"state", "n1", "n2"}) std::filesystem::create_directories(path(folder));
    const std::string host = app::run_program({"hostname", "-s"}).output, name = host.substr(0, host.find('\n'));
    std::set<int> ports;
    while (ports.size() < 3) ports.insert(free_port());
    auto port = ports.begin();
    std::string conf = fmt::format(R"(ClusterName=test
SlurmctldHost={1}(127.0.0.1)
SlurmctldPort={2}
AuthInfo=socket={0}/munge.sock
SlurmUser={3}
SlurmdUser={3}
SlurmctldPidFile={0}/slurmctld.pid
SlurmdPidFile={0}/slurmd-%n.pid
SlurmdSpoolDir={0}/%n
StateSaveLocation={0}/state
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SwitchType=switch/none
MpiDefault=none
ReturnToService=2
SlurmdTimeout=5
KillWait=2
MaxArraySize=4
SchedulerParameters=sched_interval=2,bf_interval=2
)",
                                   folder_.string(), name, *port++, user());
    for (const char* node : {"n1", "n2"})
      conf += fmt::format("NodeName={} NodeHostname={} NodeAddr=127.0.0.1 Port={} CPUs=1\n", node, name, *port++);
    conf += "PartitionName=farm Nodes=n1,n2 Default=YES State=UP\n";
    ::setenv("SLURM_CONF", write("slurm.conf", conf).c_str(), 1);
    daemon("munged", {"munged", "--foreground", "--force", "--key-file=" + path("munge.key"),
                      "--socket=" + path("munge.sock"), "--pid-file=" + path("munged.pid"),
                      "--log-file=" + path("munged.log"), "--seed-file=" + path("munged.seed")});
    ASSERT_TRUE(eventually(20, [&] { return std::filesystem::exists(path("munge.sock")); })) << read("munged.out");
    daemon("slurmctld", {"slurmctld", "-D"});
    daemon("n1", {"slurmd", "-D", "-N", "n1"});
    daemon("n2", {"slurmd", "-D", "-N", "n2"});
    ASSERT_TRUE(eventually(60,
                           [&] {
                             return slurm({"sinfo", "--noheader", "--format=%D %t"}) == "2 idle\n";
                           }))
        << read("slurmctld.out") << read("n1.out");
  }

  /// Returns the output of a Slurm command, or an empty string if it fails.
  std::string slurm(std::vector<std::string> command) { return app::run_program(std::move(command)).output; }

  static bool eventually(int seconds, const std::function<bool()>& holds) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(seconds);
    while (!holds()) {
      if (std::chrono::steady_clock::now() > end) return false;
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    return true;
  }

  Outcome sequence(const std::string& command, const std::string& folder, std::vector<std::string> more) const {
    std::filesystem::create_directories(path(folder));
    std::vector<std::string> arguments = {command,           scene_,
                                          "--fps",           "12",
                                          "--frames",        "1-12",
                                          "--output",        path(folder + "/s.##.exr"),
                                          "--png",           path(folder + "/s.png"),
                                          "--method",        "raytrace",
                                          "--light-samples", "1024"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }
  /// Returns whether the file is the log of a task or a summary; frames have separate logs.
  static bool is_log(const std::filesystem::path& path) {
    return path.extension() == ".log" && !path.filename().string().starts_with("frame-");
  }
  /// Returns all logs of a farm's folder.
  std::string logs(const std::string& folder) const {
    std::string all;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
      if (is_log(entry.path())) all += file_text(entry.path());
    }
    return all;
  }

  /// Kills a node's daemon, the processes that watch its jobs, and the jobs, as if its plug were pulled.
  void kill_node(const std::string& node) const {
    const auto environment_has = [](const std::filesystem::path& process, const std::string& variable) {
      return ('\0' + file_text(process / "environ")).find('\0' + variable + '\0') != std::string::npos;
    };
    const std::string conf = "SLURM_CONF=" + path("slurm.conf");
    std::set<pid_t> victims;
    for (const pid_t job : processes([&](const auto& process) {
           return environment_has(process, conf) && environment_has(process, "SLURMD_NODENAME=" + node);
         })) {
      victims.insert(job);
      std::ifstream status("/proc/" + std::to_string(job) + "/status");
      for (std::string word; status >> word;) {
        pid_t parent = 0;
        if (word != "PPid:" || !(status >> parent)) continue;
        if (file_text("/proc/" + std::to_string(parent) + "/comm").starts_with("slurmstepd")) victims.insert(parent);
      }
    }
    ASSERT_FALSE(victims.empty()) << "no job was running there";
    victims.insert(std::stoi(read("slurmd-" + node + ".pid")));
    for (const pid_t victim : victims) ::kill(victim, SIGKILL);
  }

  std::string scene_;
  std::vector<std::unique_ptr<ChildProgram>> daemons_;
};

/// Twelve frames on two nodes; the first node is killed while it renders, after it has finished a frame of its task.
TEST_F(FarmSlurmFull, NothingIsLostWithANodeAndNothingRenderedTwice) {
  const Outcome alone = sequence("render", "whole", {"--exposure", "first"});
  ASSERT_EQ(alone.code, 0) << alone.err;
  const std::string folder = "farm b'c\"d$(exit 3)%1";
  const Outcome outcome = sequence("submit", folder, {"--chunk", "1"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("11 frames in 4 tasks")) << "as many as an array may have";

  const std::string farm = path(folder + "/s.farm");
  std::string victim;
  ASSERT_TRUE(eventually(120, [&] {
    for (const auto& entry : std::filesystem::directory_iterator(farm)) {
      const std::string text = is_log(entry.path()) ? file_text(entry.path()) : "";
      const auto frames = static_cast<int>(std::ranges::count(text, '\n')) - 1;
      if (text.find(".exr: ") == std::string::npos || frames > 2) continue;
      victim = text.find(" on n1,") != std::string::npos ? "n1" : "n2";
      return true;
    }
    return false;
  })) << logs(farm);
  kill_node(victim);
  std::map<std::string, ino_t> before;
  for (const auto& entry : std::filesystem::directory_iterator(path(folder))) {
    struct stat status {};
    if (::stat(entry.path().c_str(), &status) == 0) before[entry.path().filename()] = status.st_ino;
  }

  const std::string summary =
      outcome.out.substr(outcome.out.find(' ') + 1, outcome.out.find('\n') - outcome.out.find(' ') - 1);
  const std::string summary_log = farm + "/summary-" + summary + ".log";
  ASSERT_TRUE(eventually(400, [&] { return file_text(summary_log).find('\n') != std::string::npos; }))
      << slurm({"squeue"}) << slurm({"sinfo"}) << logs(farm) << read("slurmctld.out");
  EXPECT_THAT(file_text(summary_log), HasSubstr("all 12 frames exist"));
  EXPECT_THAT(read("slurmctld.out"), HasSubstr("due to failure of node " + victim));
  const std::string said = logs(farm) + outcome.err;
  for (int frame = 1; frame <= 12; ++frame) {
    for (const char* extension : {".exr", ".png"}) {
      const std::string name = fmt::format("s.{:02}{}", frame, extension);
      const std::string number = fmt::format("s.{:04}{}", frame, extension);
      const std::string& used = std::string(extension) == ".png" ? number : name;
      EXPECT_EQ(read(folder + "/" + used), read("whole/" + used)) << used;
      struct stat status {};
      ASSERT_EQ(::stat(path(folder + "/" + used).c_str(), &status), 0) << used;
      if (before.contains(used)) {
        EXPECT_EQ(before.at(used), status.st_ino) << used << " was rendered twice";
      }
    }
    const std::string made = fmt::format("s.{:02}.exr: ", frame);
    const auto first = said.find(made);
    EXPECT_EQ(first == std::string::npos ? first : said.find(made, first + 1), std::string::npos)
        << frame << " was rendered twice";
    const std::string own = file_text(farm + fmt::format("/frame-{:04}.log", frame));
    EXPECT_THAT(own, HasSubstr(made));
    EXPECT_EQ(own.find(".exr: "), own.rfind(".exr: ")) << own;
  }
  EXPECT_GE(before.size(), 4u) << "the first frame, and one of the task";
  RecordProperty("picturesBeforeTheKill", static_cast<int>(before.size()));
}

/// A frame that no task can render is submitted once more and reported; the other frames are there.
TEST_F(FarmSlurmFull, AFrameThatFailsIsReported) {
  std::filesystem::create_directories(path("farm/s.03.exr"));
  const Outcome outcome = sequence("submit", "farm", {"--chunk", "4", "--size", "24x16"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  ASSERT_TRUE(eventually(120, [&] { return logs(path("farm/s.farm")).find("are missing: 3\n") != std::string::npos; }))
      << logs(path("farm/s.farm")) << slurm({"squeue"});
  EXPECT_THAT(logs(path("farm/s.farm")), HasSubstr("error: frame 3: "));
  const std::string again = read("farm/s.farm/array-job");
  EXPECT_NE(outcome.out.substr(0, outcome.out.find(' ')), again) << "it was submitted twice";
  EXPECT_TRUE(eventually(30, [&] { return slurm({"squeue", "--noheader"}).empty(); }));
  std::filesystem::remove(path("farm/s.03.exr"));
  const Outcome repaired = sequence("submit", "farm", {"--chunk", "4", "--size", "24x16"});
  ASSERT_EQ(repaired.code, 0) << repaired.err;
  EXPECT_THAT(repaired.err, HasSubstr("1 frames in 1 tasks"));
  EXPECT_TRUE(
      eventually(120, [&] { return logs(path("farm/s.farm")).find("all 12 frames exist") != std::string::npos; }))
      << logs(path("farm/s.farm")) << slurm({"squeue"});
}

/// A cancelled array is not submitted again; the first frame may itself be rendered by a job on the farm.
TEST_F(FarmSlurmFull, WhatWasCancelledIsReportedAndNotSubmittedAgain) {
  const Outcome outcome = sequence("submit", "farm", {"--chunk", "4"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const std::string array = read("farm/s.farm/array-job");
  const Outcome twice = sequence("submit", "farm", {"--chunk", "4"});
  EXPECT_EQ(twice.code, 2);
  EXPECT_THAT(twice.err, HasSubstr("being rendered as job " + array));
  (void)slurm({"scancel", array});
  ASSERT_TRUE(
      eventually(120, [&] { return logs(path("farm/s.farm")).find("frames are missing") != std::string::npos; }))
      << logs(path("farm/s.farm")) << slurm({"squeue"});
  EXPECT_TRUE(eventually(30, [&] { return slurm({"squeue", "--noheader"}).empty(); }));
  EXPECT_EQ(read("farm/s.farm/array-job"), array);

  const std::vector<std::string> words = {"srun", "--exclusive", PENUMBRA_PROGRAM, "submit", scene_,  "--frames",
                                          "0-3",  "-o",          path("t.exr"),    "--size", "24x16", "--chunk",
                                          "2"};
  const app::ProgramEnding ending = app::run_program(words);
  EXPECT_EQ(ending.code, 0) << ending.errors;
  EXPECT_TRUE(eventually(120, [&] { return logs(path("t.farm")).find("all 4 frames exist") != std::string::npos; }))
      << logs(path("t.farm")) << slurm({"squeue"});
}

}  // namespace
}  // namespace penumbra::tests
