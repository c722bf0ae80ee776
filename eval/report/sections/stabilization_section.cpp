#include "eval/report/sections/module_sections.h"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <filesystem>
#include <vector>

#include "core/io/files/file_list.h"
#include "core/io/images/image_file.h"
#include "eval/metrics/sharpness.h"
#include "eval/picture/image/log_picture.h"
#include "eval/picture/view/stabilized_view.h"
#include "eval/report/html.h"

namespace saccade {
namespace {

constexpr double kStabilizedMoments[] = {0.15, 0.5, 0.85};

std::size_t index_at(double fraction, std::size_t count) {
  return static_cast<std::size_t>(fraction * static_cast<double>(count - 1) + 0.5);
}

std::string event_pictures(const std::filesystem::path& folder, const Dataset& dataset) {
  const StabilizedRun run = load_stabilized(folder);
  if (run.windows.empty()) return "";
  std::string html = "<h4>Events before and after stabilization</h4><div class=\"grid\">";
  for (const double fraction : kStabilizedMoments) {
    const std::size_t i = index_at(fraction, run.windows.size());
    const StabilizedWindow& window = run.windows[i];
    const WindowImages images = images_of(run, i, dataset);
    const float most = quantile(images.stabilized, {}, 0.99F);
    const std::string at = fmt::format("{:.3f} .. {:.3f} s: ", window.start_s, window.end_s);
    html += upscaled_figure(draw_counts(images.raw, most),
                            at + fmt::format("as fired, sharpness {:.1f}", sharpness(images.raw)),
                            "events before stabilization") +
            upscaled_figure(
                draw_counts(images.stabilized, most),
                at + fmt::format("stabilized, sharpness {:.1f}", sharpness(images.stabilized)),
                "events after stabilization");
  }
  return html + "</div>\n";
}

std::string frame_pictures(const std::filesystem::path& folder, const Dataset& dataset) {
  const std::vector<StampedFile> files = read_file_list(folder / "images.txt");
  if (files.empty()) return "";
  std::string html = "<h4>Frames before and after stabilization</h4><div class=\"grid\">";
  for (const double fraction : kStabilizedMoments) {
    const StampedFile& file = files[index_at(fraction, files.size())];
    for (std::size_t i = 0; i < dataset.frames().size(); ++i) {
      if (std::abs(dataset.frames()[i].t_s - file.t_s) > 1e-6) continue;
      const std::string at = fmt::format("{:.3f} s: ", file.t_s);
      html += upscaled_figure(draw_frame(dataset.load_frame(i)), at + "frame",
                              "frame before stabilization") +
              upscaled_figure(read_image_rgb(file.file), at + "stabilized",
                              "frame after stabilization");
    }
  }
  return html + "</div>\n";
}

}  // namespace

std::string stabilization_section(const RunData& data) {
  if (!data.data) return "";
  const std::filesystem::path folder = data.run.folder / "stabilized";
  std::string html;
  if (std::filesystem::exists(folder / "windows.csv")) html += event_pictures(folder, *data.data);
  if (std::filesystem::exists(folder / "images.txt")) html += frame_pictures(folder, *data.data);
  return html;
}

}  // namespace saccade
