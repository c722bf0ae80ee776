#include "eval/report/sections/module_sections.h"

#include <fmt/format.h>
#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <optional>

#include "core/io/files/file_bytes.h"
#include "core/io/files/scratch_folder.h"
#include "core/io/images/image_file.h"
#include "core/io/images/webp_file.h"
#include "eval/mosaic_view.h"
#include "eval/picture/render.h"
#include "eval/picture/view/sensor_view.h"
#include "eval/picture/view/view_pictures.h"
#include "eval/report/html.h"

namespace saccade {
namespace {

constexpr double kFilmS = 6;
constexpr double kFilmFps = 10;
constexpr int kSmallFilm = 37;  ///< of RenderOptions::crf: noise of events goes, edges stay
/// [px]; smaller sensors are enlarged to at least this, which captions need.
constexpr int kPictureWidth = 480;
constexpr std::size_t kLeastViews = 8;  ///< fewer make no film

RunRecord::Window span_of(const RunData& data) {
  RunRecord::Window span = time_span(*data.data);
  if (const auto& window = data.run.record.window) {
    span.start_s = std::max(span.start_s, window->start_s);
    span.end_s = std::min(span.end_s, window->end_s);
  }
  return span;
}

/// H.264
std::string film_bytes(const RunData& data, const RenderOptions& options) {
  const ScratchFolder scratch;
  const std::filesystem::path file = scratch.path() / "film.mp4";
  render(data.run.folder, file, options);
  const std::vector<std::byte> bytes = read_file_bytes(file);
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// The moment `options.time_s` as WebP.
std::string poster_bytes(const RunData& data, const RenderOptions& options) {
  const ScratchFolder scratch;
  const std::filesystem::path file = scratch.path() / "poster.png";
  render(data.run.folder, file, options);
  return encode_webp(read_image_rgb(file));
}

/// nullopt where the film would hold next to nothing: of a few views or of a finished mosaic.
std::optional<RenderOptions> film_options(const RunData& data, double length_s) {
  RenderOptions options;
  const int width = data.data->camera().width;
  options.upscale = std::clamp((kPictureWidth + width - 1) / width, 1, 8);
  options.slow_motion = kFilmS / length_s;
  options.crf = kSmallFilm;
  if (!growth_steps(data.run.folder).empty()) return options;
  if (!data.keyframes) {
    if (load_mosaic(data.run)) return std::nullopt;
    const std::size_t views = ViewPictures(data.run, *data.data).times().size();
    if (views > 0) return views < kLeastViews ? std::nullopt : std::optional(options);
  }
  options.fps = kFilmFps;
  return options;
}

}  // namespace

std::string film_section(const RunData& data) {
  if (!data.data || data.data->events_file().empty() || !data.run.record.problem().empty())
    return "";
  const RunRecord::Window span = span_of(data);
  const double length_s = span.end_s - span.start_s;
  if (!(length_s > 0)) return "";
  std::optional<RenderOptions> options = film_options(data, length_s);
  if (!options) return "";
  const std::string film = base64(film_bytes(data, *options));
  options->time_s = span.start_s + length_s / 2;
  const std::string poster = base64(poster_bytes(data, *options));
  return fmt::format(
      "<figure class=\"film\"><video controls loop muted playsinline preload=\"none\" "
      "poster=\"data:image/webp;base64,{}\" src=\"data:video/mp4;base64,{}\"></video>"
      "<figcaption>The run as a film, {:.3f} s .. {:.3f} s.</figcaption></figure>\n",
      poster, film, span.start_s, span.end_s);
}

}  // namespace saccade
