#include "apps/convert_poses.h"

#include <fmt/format.h>

#include <map>

#include "core/error.h"
#include "core/io/colmap_file.h"
#include "core/io/dataset/dataset.h"
#include "core/io/export/pose_export.h"
#include "core/io/trajectory_file.h"
#include "eval/run_folder.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;

bool is_run_folder(const fs::path& path) { return fs::exists(path / "run.yaml"); }

std::string written(const fs::path& output, std::size_t poses) {
  return fmt::format("{}: {} poses\n", output.string(), poses);
}

std::string convert_colmap(const PoseConversion& conversion) {
  if (conversion.dataset.empty())
    throw InputError("--data",
                     "COLMAP's pictures have no times; name the dataset whose images.txt has them: "
                     "--data DATASET");
  std::map<std::string, double> times;
  const Dataset dataset = Dataset::open(conversion.dataset);
  for (const StampedFile& frame : dataset.frames())
    times.emplace(frame.file.filename().string(), frame.t_s);
  const Trajectory trajectory = trajectory_of(read_colmap_images(conversion.input), times);
  write_tum_trajectory(conversion.output, trajectory.poses());
  return written(conversion.output, trajectory.size());
}

std::string convert_csv(const PoseConversion& conversion) {
  const Trajectory trajectory = read_csv_trajectory(conversion.input);
  write_tum_trajectory(conversion.output, trajectory.poses());
  return written(conversion.output, trajectory.size());
}

std::string convert_to_nerfstudio(const PoseConversion& conversion) {
  if (!is_run_folder(conversion.input)) {
    const Dataset dataset = Dataset::open(conversion.input);
    return written(conversion.output,
                   write_nerfstudio(dataset, dataset.groundtruth(), conversion.output));
  }
  const RunFolder run = RunFolder::open(conversion.input);
  return written(conversion.output,
                 write_nerfstudio(run.open_dataset(), run.trajectory.value_or(Trajectory()),
                                  conversion.output));
}

std::string convert_run(const PoseConversion& conversion) {
  const RunFolder run = RunFolder::open(conversion.input);
  const Trajectory estimate = run.trajectory.value_or(Trajectory());
  write_trajectory_evaluation(run.open_dataset().groundtruth(), estimate, conversion.output);
  return written(conversion.output, estimate.size());
}

}  // namespace

std::string convert_poses(const PoseConversion& conversion) {
  const bool is_text = conversion.output.extension() == ".txt";
  if (is_text && is_colmap_images(conversion.input)) return convert_colmap(conversion);
  if (!conversion.dataset.empty())
    throw InputError("--data", "belongs to poses of COLMAP (images.txt) that become a .txt");
  if (is_text && is_csv_trajectory(conversion.input)) return convert_csv(conversion);
  if (conversion.output.extension() == ".json" && fs::is_directory(conversion.input))
    return convert_to_nerfstudio(conversion);
  if (conversion.output.extension().empty() && is_run_folder(conversion.input))
    return convert_run(conversion);
  return "";
}

}  // namespace saccade
