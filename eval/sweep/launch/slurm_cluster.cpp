#include "eval/sweep/launch/slurm_cluster.h"

#include <fmt/format.h>
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <cstdlib>

#include "core/error.h"
#include "core/process/shell.h"

namespace saccade {
namespace {

using SlurmWords = std::vector<std::string>;

/// Slurm's default of MaxArraySize.
constexpr int kDefaultMaxArraySize = 1001;

/// The result of a Slurm command.
struct SlurmAnswer {
  int exit_code = -1;
  std::string text;  ///< stdout and stderr
};

SlurmAnswer ask(const SlurmWords& words) {
  FILE* pipe = popen((shell_line(words) + " 2>&1 </dev/null").c_str(), "re");
  if (pipe == nullptr) return {};
  SlurmAnswer answer;
  std::array<char, 4096> part{};
  while (const std::size_t size = std::fread(part.data(), 1, part.size(), pipe))
    answer.text.append(part.data(), size);
  const int status = pclose(pipe);
  if (WIFEXITED(status)) answer.exit_code = WEXITSTATUS(status);
  while (answer.text.ends_with('\n')) answer.text.pop_back();
  return answer;
}

}  // namespace

void SlurmCommands::check() {
  for (const char* program : {"sbatch", "squeue", "scancel", "scontrol"}) {
    const SlurmAnswer answer = ask({program, "--version"});
    if (answer.exit_code != 0)
      throw InputError("--launcher slurm",
                       fmt::format("'{} --version' fails: {}\n  Slurm's programs are needed here "
                                   "(Debian: slurm-client), on a machine that may submit jobs; "
                                   "--launcher local runs on this machine alone",
                                   program, answer.text));
  }
  const SlurmAnswer ping = ask({"squeue", "--noheader", "--me"});
  if (ping.exit_code != 0)
    throw InputError("--launcher slurm", "the cluster does not answer: " + ping.text);
}

int SlurmCommands::max_array_size() {
  const SlurmAnswer answer = ask({"scontrol", "show", "config"});
  // "MaxArraySize            = 1001", one above the highest index of a task.
  const std::size_t key = answer.text.find("MaxArraySize");
  const std::size_t value =
      key == std::string::npos ? key : answer.text.find_first_of("0123456789\n", key);
  const int told = value == std::string::npos ? 0 : std::atoi(answer.text.c_str() + value);
  return told > 0 ? told : kDefaultMaxArraySize;
}

std::string SlurmCommands::submit(const std::filesystem::path& script, const SlurmWords& options) {
  SlurmWords words{"sbatch", "--parsable"};
  words.insert(words.end(), options.begin(), options.end());
  words.push_back(script.string());
  const SlurmAnswer answer = ask(words);
  if (answer.exit_code == 0) return {};
  return answer.text + "\n  " + shell_line(words);
}

std::optional<SlurmQueue> SlurmCommands::queue(const SlurmWords& arrays) {
  std::string names;
  for (const std::string& array : arrays) names += (names.empty() ? "" : ",") + array;
  const SlurmAnswer answer = ask({"squeue", "--noheader", "--array", "--states=all",
                                  "--name=" + names, fmt::format("--format={}", kSqueueFormat)});
  if (answer.exit_code != 0) return std::nullopt;
  return SlurmQueue(answer.text);
}

void SlurmCommands::cancel(const SlurmWords& arrays) {
  for (const std::string& array : arrays) (void)ask({"scancel", "--name=" + array});
}

}  // namespace saccade
