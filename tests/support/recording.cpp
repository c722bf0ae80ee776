#include "tests/support/recording.h"

#include <cstddef>
#include <fstream>
#include <string>

#include "core/check.h"
#include "core/io/images/image_file.h"
#include "core/io/trajectory_file.h"

namespace saccade::testing {

void write_recording(const std::filesystem::path& folder, const PinholeCamera& camera,
                     std::span<const Event> events, std::span<const StampedPicture> pictures,
                     std::span<const StampedPose> poses) {
  SACCADE_CHECK(!pictures.empty());
  std::filesystem::create_directories(folder / "images");
  std::ofstream lines(folder / "events.txt");
  lines.precision(9);
  lines << std::fixed;
  for (const Event& e : events)
    lines << seconds_from_ns(e.t_ns) << ' ' << e.x << ' ' << e.y << ' ' << (e.polarity > 0 ? 1 : 0)
          << '\n';
  std::ofstream(folder / "calib.txt")
      << camera.fx << ' ' << camera.fy << ' ' << camera.cx << ' ' << camera.cy << " 0 0 0 0 0\n";
  std::ofstream list(folder / "images.txt");
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    const std::string name = "images/" + std::to_string(i) + ".png";
    list << pictures[i].t_s << ' ' << name << '\n';
    write_png(folder / name, pictures[i].picture);
  }
  write_tum_trajectory(folder / "groundtruth.txt", poses);
}

}  // namespace saccade::testing
