// The configuration of every module, and the adapters of external programs among them.

#include <string>

#include "core/config/config.h"
#include "core/error.h"
#include "estimator/external/command_template.h"
#include "estimator/registry.h"
#include "tests/fuzz/fuzz_target.h"

namespace saccade::fuzz {
namespace {

namespace fs = std::filesystem;

std::string file_of(const Module& module) { return std::string(module.name) + ".yaml"; }

void write_modules(const fs::path& folder) {
  for (const Module& module : modules())
    write_bytes(folder / file_of(module), std::string_view(module.name) == "external"
                                              ? "command: run {events} {out}\nname: a\n"
                                              : module.print_config(config::Document::empty()));
}

/// The resolved configuration reads as itself.
void decode_modules(const fs::path& folder, const std::string& file) {
  const Module& module = find_module(file.substr(0, file.find('.')));
  const std::string once = module.print_config(config::load(folder / file));
  if (module.print_config(config::parse(once, "print")) != once)
    throw std::logic_error("what is printed reads as something else");
}

void write_adapters(const fs::path& folder) {
  write_bytes(folder / "adapter.yaml",
              "name: mine\ncommand: \"prog --in {events} --out {out} 'a {{b' "
              "\\\"{seed}\\\"\"\nversion_command: prog -v\n"
              "output: {trajectory: {file: t.txt}}\n");
}

void decode_adapters(const fs::path& folder, const std::string& file) {
  const auto adapter = config::read<AdapterConfig>(config::load(folder / file));
  const Placeholders values{{"events", "a b"}, {"out", "$(c)"}};
  const std::string problem = placeholder_problem(adapter.command, adapter);
  if (!problem.empty()) throw InputError("command", problem);
}

std::vector<std::string> module_files() {
  std::vector<std::string> files;
  for (const Module& module : modules()) files.push_back(file_of(module));
  return files;
}

std::vector<std::string> key_names() {
  std::vector<std::string> words;
  for (const Module& module : modules())
    for (const config::ReferenceKey& key : module.reference())
      words.push_back(key.name.substr(key.name.rfind('.') + 1) + ": ");
  return words;
}

}  // namespace

const std::vector<Target>& targets() {
  static const std::vector<Target> all{
      {"modules", module_files(), decode_modules, write_modules, key_names()},
      {"adapters",
       {"adapter.yaml"},
       decode_adapters,
       write_adapters,
       {"{events}", "{out}", "{{", "}}", "'", "\\\"", "$(", "files: ", "timeout_s: "}}};
  return all;
}

}  // namespace saccade::fuzz
