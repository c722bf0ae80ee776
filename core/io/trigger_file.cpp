#include "core/io/trigger_file.h"

#include <string>

#include "core/io/files/atomic_file.h"
#include "core/io/tables/text_table.h"

namespace saccade {

void write_triggers(const std::filesystem::path& file, std::span<const Trigger> triggers) {
  std::string text = "# t type\n";
  for (const Trigger& trigger : triggers) {
    append_decimal_seconds(trigger.t_ns, text);
    text += " " + std::to_string(trigger.type) + "\n";
  }
  write_atomically(file, text);
}

}  // namespace saccade
