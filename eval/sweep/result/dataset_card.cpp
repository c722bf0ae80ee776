#include "eval/sweep/result/dataset_card.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "core/io/dataset/dataset.h"
#include "core/io/files/atomic_file.h"
#include "core/io/images/image_file.h"
#include "core/median.h"
#include "eval/picture/canvas/contact_sheet.h"
#include "eval/picture/view/sensor_view.h"
#include "eval/table/number_text.h"
#include "eval/table/table.h"

namespace saccade {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kPictured = 6;

std::vector<const Json*> existing(const Json& manifest) {
  std::vector<const Json*> rows;
  for (const Json& row : manifest["datasets"])
    if (row["status"] == "ok") rows.push_back(&row);
  return rows;
}

/// Sums over the datasets of a scene and split.
struct Part {
  std::size_t datasets = 0;
  double duration_s = 0, events = 0, bytes = 0;

  void add(const Json& row) {
    ++datasets;
    duration_s += row["duration_s"].get<double>();
    events += row["events"].get<double>();
    bytes += row["bytes"].get<double>();
  }
};

void add_part(Table& table, const std::string& scene, const std::string& split, const Part& part) {
  table.add({scene, split, std::to_string(part.datasets), significant(part.duration_s),
             significant(part.events / 1e6), significant(part.bytes / 1e6)});
}

std::string parts_text(const std::vector<const Json*>& rows) {
  std::map<std::pair<std::string, std::string>, Part> parts;
  Part all;
  for (const Json* row : rows) {
    parts[{(*row)["scene"], (*row)["split"]}].add(*row);
    all.add(*row);
  }
  Table table{.columns = {{"scene"}, {"split"}}};
  table.add_numeric({"datasets", "duration [s]", "events [million]", "size [MB]"});
  for (const auto& [key, part] : parts) add_part(table, key.first, key.second, part);
  add_part(table, "all", "", all);
  return table_markdown(table);
}

/// The numbers of all datasets by name: rates, and what was sampled as a number.
std::map<std::string, std::vector<double>> numbers_of(const std::vector<const Json*>& rows) {
  std::map<std::string, std::vector<double>> numbers;
  for (const Json* row : rows) {
    for (const char* key : {"mean_rate_hz", "path_length_m", "mean_scene_depth_m", "duration_s"})
      if (const Json& value = (*row)[key]; value.is_number())
        numbers[key].push_back(value.get<double>());
    for (const auto& [key, value] : (*row)["drawn"].items())
      if (value.is_number()) numbers[key].push_back(value.get<double>());
  }
  return numbers;
}

std::string statistics_text(const std::vector<const Json*>& rows) {
  Table table{.columns = {{"quantity"}}};
  table.add_numeric({"least", "median", "most"});
  for (const auto& [key, values] : numbers_of(rows)) {
    const auto [least, most] = std::minmax_element(values.begin(), values.end());
    table.add(
        {"`" + key + "`", significant(*least), significant(median(values)), significant(*most)});
  }
  return table_markdown(table);
}

std::vector<CaptionedPicture> pictures_of(const std::filesystem::path& folder) {
  const Dataset dataset = Dataset::open(folder);
  const RunRecord::Window span = time_span(dataset);
  const double t_s = (span.start_s + span.end_s) / 2;
  const SensorView view(dataset, t_s, t_s, {.upscale = 1});
  std::vector<CaptionedPicture> pictures{
      {fmt::format("events at {:.3f} s", t_s), view.events(t_s)}};
  if (auto frame = view.frame(t_s)) pictures.push_back({"frame", std::move(*frame)});
  if (auto depth = view.plain_depth(t_s)) pictures.push_back({"depth", std::move(depth->image)});
  return pictures;
}

ImageRgb8 sheet_of(const Json& manifest, const std::vector<const Json*>& rows,
                   const std::filesystem::path& folder) {
  ContactSheet sheet(manifest["title"].get<std::string>(), kDarkTheme);
  const std::size_t count = std::min(kPictured, rows.size());
  for (std::size_t i = 0; i < count; ++i) {
    const Json& row = *rows[(2 * i + 1) * rows.size() / (2 * count)];
    sheet.add_row(row["name"].get<std::string>(),
                  pictures_of(folder / row["path"].get<std::string>()));
  }
  return sheet.draw();
}

}  // namespace

std::string dataset_card(const Json& manifest, bool has_picture) {
  const std::vector<const Json*> rows = existing(manifest);
  const std::string title = manifest["title"].get<std::string>();
  std::string text = fmt::format("# {}\n\n", title.empty() ? "Generated datasets" : title);
  text += fmt::format(
      "{} of {} datasets, simulated by saccade {} ({}) from sweep.yaml beside this page (SHA-256 "
      "{}). Each has the layout of a dataset of saccade; manifest.json and manifest.csv list all "
      "of "
      "them with their hashes, train.txt, val.txt and test.txt those of a split.\n\n",
      rows.size(), manifest["datasets"].size(), manifest["tool_version"].get<std::string>(),
      manifest["commit"].get<std::string>(), manifest["sweep_sha256"].get<std::string>());
  if (!rows.empty()) {
    text += "## Parts\n" + parts_text(rows) + "\n## Statistics\n" + statistics_text(rows) + "\n";
    if (has_picture) text += "![Events, frames and depth of some of the datasets](card.png)\n\n";
  }
  return text +
         "## Made again\nThe same program makes the same bytes, of all datasets or of one by its "
         "index:\n```\nsaccade sweep sweep.yaml -o again\nsaccade sweep sweep.yaml -o one --set "
         "generate.first=INDEX --set generate.count=1\n```\n";
}

void write_dataset_card(const Json& manifest, const std::filesystem::path& folder) {
  const std::vector<const Json*> rows = existing(manifest);
  if (!rows.empty()) write_png(folder / "card.png", sheet_of(manifest, rows, folder));
  write_atomically(folder / "card.md", dataset_card(manifest, !rows.empty()));
}

}  // namespace saccade
