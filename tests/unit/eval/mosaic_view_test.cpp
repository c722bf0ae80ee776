#include "eval/mosaic_view.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/io/images/exr_file.h"
#include "core/io/images/image_file.h"
#include "core/io/images/panorama_file.h"
#include "core/io/run/run_record.h"
#include "core/io/trajectory_file.h"
#include "eval/picture/render.h"
#include "eval/report/report.h"
#include "tests/support/command.h"
#include "tests/support/direction_world.h"
#include "tests/support/error_of.h"
#include "tests/support/shared_folder.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using testing::DirectionWorld;
using testing::error_of;
using ::testing::HasSubstr;

constexpr double kTurn_s = 0.6;

/// A dataset of the sky and runs that claim to have seen it.
class MosaicScores : public testing::SharedFolder<MosaicScores> {
 public:
  static void fill() { testing::write_sky_dataset(dataset(), turning(), kTurn_s); }

 protected:
  [[nodiscard]] static testing::OrientationFunction turning() { return testing::sweep(0.4, 1.5); }
  [[nodiscard]] static fs::path dataset() { return path("sky"); }

  /// The true mosaic in a world whose heading is another one, its orientations drifting.
  [[nodiscard]] static RunFolder write_run(const std::string& name, double heading, double drift) {
    const fs::path run = path(name);
    fs::create_directories(run);
    const Eigen::Quaterniond other(Eigen::AngleAxisd(heading, Eigen::Vector3d::UnitZ()));
    std::vector<StampedPose> poses;
    std::vector<Eigen::Matrix3d> turns;
    for (int i = 0; i <= static_cast<int>(1000 * kTurn_s); ++i) {
      const double t_s = 1e-3 * i;
      const Eigen::Quaterniond slip(Eigen::AngleAxisd(drift * t_s, Eigen::Vector3d::UnitZ()));
      poses.push_back({t_s, {slip * other * turning()(t_s), Eigen::Vector3d::Zero()}});
      turns.push_back((other * turning()(t_s)).toRotationMatrix());
    }
    const FieldOfView camera(testing::small_camera());
    const Panorama panorama = panorama_around(camera, turns, 60);
    ImageF image(panorama.width, panorama.height), observed = image;
    const ImageU8 seen = seen_by(camera, turns, panorama);
    for (int y = 0; y < image.height(); ++y)
      for (int x = 0; x < image.width(); ++x) {
        // Scale and offset do not count.
        image(x, y) = 2 + 0.5F * static_cast<float>(DirectionWorld::log_intensity(
                                     other.conjugate() * panorama.direction(x, y)));
        observed(x, y) = seen(x, y);
      }
    const ExrChannel channels[] = {{"L", image}, {"observed", observed}};
    write_exr(run / "mosaic.exr", channels);
    write_panorama(run / "mosaic.yaml", panorama);
    write_orientations(run / "orientation.txt", poses);
    RunRecord record;
    record.module = "mosaic";
    record.dataset = dataset();
    write_run_record(run / "run.yaml", record);
    return RunFolder::open(run);
  }

  [[nodiscard]] static Metrics score(const RunFolder& run) {
    return score_mosaic(compare_mosaic(load_mosaic(run).value(), run, Dataset::open(dataset())));
  }
};

TEST_F(MosaicScores, TheTruthInAnotherHeadingIsPerfect) {
  const Metrics metrics = score(write_run("perfect", 1.9, 0));
  EXPECT_GT(metrics.get("mosaic.ssim").value(), 0.99);
  EXPECT_GT(metrics.get("mosaic.pearson").value(), 0.999);
  EXPECT_NEAR(metrics.get("mosaic.fit.scale").value(), 2, 0.01);
  EXPECT_NEAR(metrics.get("mosaic.aligned.ssim").value(), metrics.get("mosaic.ssim").value(), 1e-3);
  EXPECT_NEAR(metrics.get("mosaic.alignment.rotation_deg").value(), 0, 1e-6);
  EXPECT_GT(metrics.get("mosaic.observed").value(), 0.97);
  EXPECT_GT(metrics.get("mosaic.span.horizontal").value(), 1.5);
  EXPECT_GT(metrics.get("mosaic.span.solid_angle").value(), 1.5);
}

TEST_F(MosaicScores, DriftIsStatedAndHalfOfItAlignedAway) {
  const Metrics metrics = score(write_run("drifting", -2.5, 0.05));
  const double drift_deg = 0.05 * kTurn_s * 180 / 3.14159265;
  EXPECT_NEAR(metrics.get("mosaic.alignment.rotation_deg").value(), drift_deg / 2, 0.01);
  EXPECT_NEAR(metrics.get("mosaic.alignment.residual_deg").value(), drift_deg / std::sqrt(12.0),
              0.01);
}

TEST_F(MosaicScores, WithoutATruePanoramaThereAreNone) {
  const fs::path bare = dataset().parent_path() / "bare";
  fs::copy(dataset(), bare);
  fs::remove(bare / "panorama.exr");
  const RunFolder run = write_run("unknown", 0, 0);
  const auto comparison = compare_mosaic(load_mosaic(run).value(), run, Dataset::open(bare));
  EXPECT_FALSE(comparison);
  EXPECT_FALSE(score_mosaic(comparison).get("mosaic.ssim"));
}

TEST_F(MosaicScores, AreInTheReportAndThePicturesBeneathEachOther) {
  const RunFolder run = write_run("shown", 0.3, 0);
  write_report({&run.folder, 1}, path("report.html"));
  const std::string html = testing::read_file(path("report.html"));
  for (const char* text : {"Mosaic", "fields of view", "never in view", "log units"})
    EXPECT_THAT(html, HasSubstr(text));
  render(run.folder, path("mosaic.png"));
  EXPECT_GT(read_image_grey(path("mosaic.png")).height(), 3 * load_mosaic(run)->panorama.height);
  EXPECT_THAT(error_of([&] { render(run.folder, path("film.mp4")); }), HasSubstr("growth"));
}

TEST_F(MosaicScores, NamesWhatIsMalformed) {
  const RunFolder run = write_run("malformed", 0, 0);
  write_panorama(run.folder / "mosaic.yaml", Panorama::sphere(40));
  EXPECT_THAT(error_of([&] { return load_mosaic(run); }), HasSubstr("another size"));
}

}  // namespace
}  // namespace saccade
