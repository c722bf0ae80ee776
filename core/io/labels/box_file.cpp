#include "core/io/labels/box_file.h"

#include <fmt/format.h>

#include <iterator>
#include <string>
#include <utility>

#include "core/io/files/atomic_file.h"
#include "core/io/tables/text_table.h"

namespace saccade {
namespace {

constexpr const char* kColumns = "t instance class x0 y0 x1 y1 visible_fraction";

std::int64_t integer_within(TextRow& row, const char* name, std::int64_t low, std::int64_t high) {
  const std::int64_t value = row.integer(name);
  if (value < low || value > high)
    row.fail(fmt::format("{} is {}, must be within [{}, {}]", name, value, low, high));
  return value;
}

InstanceBox read_box(TextRow& row) {
  constexpr std::int64_t kMost_px = 65534;
  InstanceBox box;
  box.t_s = row.number("t");
  box.instance = static_cast<std::uint16_t>(integer_within(row, "instance", 1, 65535));
  box.class_id = static_cast<std::uint8_t>(integer_within(row, "class", 0, 255));
  box.x0 = static_cast<int>(integer_within(row, "x0", 0, kMost_px));
  box.y0 = static_cast<int>(integer_within(row, "y0", 0, kMost_px));
  box.x1 = static_cast<int>(integer_within(row, "x1", box.x0, kMost_px));
  box.y1 = static_cast<int>(integer_within(row, "y1", box.y0, kMost_px));
  box.visible_fraction = row.number("visible_fraction");
  if (!(box.visible_fraction > 0 && box.visible_fraction <= 1))
    row.fail(fmt::format("visible_fraction is {:g}, must be above 0 and at most 1",
                         box.visible_fraction));
  row.expect_end(kColumns);
  return box;
}

}  // namespace

void write_boxes(const std::filesystem::path& file, std::span<const InstanceBox> boxes) {
  fmt::memory_buffer text;
  fmt::format_to(std::back_inserter(text), "# {}\n", kColumns);
  for (const InstanceBox& box : boxes)
    fmt::format_to(std::back_inserter(text), "{:.9f} {} {} {} {} {} {} {:.6f}\n", box.t_s,
                   box.instance, box.class_id, box.x0, box.y0, box.x1, box.y1,
                   box.visible_fraction);
  write_atomically(file, {text.data(), text.size()});
}

std::vector<InstanceBox> read_boxes(const std::filesystem::path& file) {
  std::vector<InstanceBox> boxes;
  for_each_row(file, [&](TextRow& row) {
    const InstanceBox box = read_box(row);
    const auto rank = [](const InstanceBox& b) { return std::pair(b.t_s, b.instance); };
    if (!boxes.empty() && !(rank(boxes.back()) < rank(box)))
      row.fail("lines must be in order of time, then of the instance");
    boxes.push_back(box);
    return true;
  });
  return boxes;
}

}  // namespace saccade
