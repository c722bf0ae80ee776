#include "eval/picture/film.h"

#include "core/progress.h"
#include "eval/picture/video.h"

namespace saccade {

void write_film(const std::filesystem::path& output, std::size_t count, double fps,
                const std::function<ImageRgb8(std::size_t)>& frame) {
  const ImageRgb8 first = frame(0);
  VideoWriter video(output, first.width(), first.height(), fps);
  Progress progress("rendering", count, "frames");
  for (std::size_t i = 0; i < count; ++i) {
    video.add(i == 0 ? first : frame(i));
    progress.add(1);
  }
  video.finish();
}

}  // namespace saccade
