#include "core/io/files/file_list.h"

#include <utility>

#include <fmt/format.h>

#include "core/io/files/atomic_file.h"
#include "core/io/tables/text_table.h"

namespace saccade {

std::vector<StampedFile> read_file_list(const std::filesystem::path& list) {
  std::vector<StampedFile> files;
  for_each_row(list, [&](TextRow& row) {
    StampedFile entry;
    entry.t_s = row.number("t");
    entry.file = list.parent_path() / row.word("file");
    row.expect_end("t file");
    if (!files.empty() && !(entry.t_s > files.back().t_s))
      row.fail(
          fmt::format("times must increase: {:.9f} s after {:.9f} s", entry.t_s, files.back().t_s));
    files.push_back(std::move(entry));
    return true;
  });
  return files;
}

void write_file_list(const std::filesystem::path& list, std::span<const StampedFile> files) {
  std::string text;
  for (const StampedFile& entry : files)
    text += fmt::format("{:.9f} {}\n", entry.t_s,
                        entry.file.lexically_proximate(list.parent_path()).generic_string());
  write_atomically(list, text);
}

}  // namespace saccade
