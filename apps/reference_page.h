#pragma once

#include <string>
#include <vector>

#include "core/config/reference.h"

namespace saccade {

/// One page of docs/reference/: every key that one kind of configuration can hold.
struct ReferencePage {
  std::string name;     ///< of the file, without .md: a module, "simulate" or "sweep"
  std::string command;  ///< "saccade run track"
  std::string about;    ///< a sentence
  std::string example;  ///< a command line that sets a key
  std::vector<config::ReferenceKey> keys;

  [[nodiscard]] std::string markdown() const;
};

/// Throws InputError when there is no page of this name.
[[nodiscard]] ReferencePage reference_page(const std::string& name);

/// The names of all pages: the modules of `saccade run`, "simulate" and "sweep".
[[nodiscard]] std::vector<std::string> reference_page_names();

}  // namespace saccade
