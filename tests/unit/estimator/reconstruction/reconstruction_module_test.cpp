#include "estimator/reconstruction/reconstruction_module.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "core/io/dataset/dataset.h"
#include "core/io/images/exr_file.h"
#include "core/io/run/run_record.h"
#include "core/io/run/view_list.h"
#include "core/process/parallel.h"
#include "estimator/reconstruction/contrast_thresholds.h"
#include "estimator/registry.h"
#include "tests/support/command.h"
#include "tests/support/error_of.h"
#include "tests/support/fake_run.h"
#include "tests/support/planar_world.h"
#include "tests/support/shared_folder.h"
#include "tests/unit/estimator/run_request.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using testing::error_of;
using ::testing::HasSubstr;
using testing::read_file;

constexpr const char* kBest =
    "{method: equations, observations: {event_sigma: 0.1, no_event_spacing_px: 1, run_events: 8}}";
constexpr const char* kThesis =
    "{method: gradient, depth: {propagation: splat}, "
    "observations: {no_event_constraints: false}}";

class ReconstructionModule : public testing::SharedFolder<ReconstructionModule> {
 public:
  static void fill() { testing::write_corner_dataset(dataset(), "corner", 0.3, 120); }

 protected:
  [[nodiscard]] static fs::path dataset() { return path("corner"); }
  [[nodiscard]] static RunRequest request(const std::string& name, const std::string& yaml) {
    return testing::run_request(dataset(), path(name), yaml);
  }

  /// Correlation of the first view's log intensity with that of the true frame at its time.
  [[nodiscard]] static double correlation(const std::string& name) {
    const RunView view = read_view_list(path(name) / "views.yaml").at(0);
    const Dataset data = Dataset::open(dataset());
    std::size_t nearest = 0;
    for (std::size_t i = 0; i < data.frames().size(); ++i)
      if (std::abs(data.frames()[i].t_s - view.t_s) <
          std::abs(data.frames()[nearest].t_s - view.t_s))
        nearest = i;
    EXPECT_NEAR(data.frames()[nearest].t_s, view.t_s, 1e-6);
    const ImageF truth = data.load_frame(nearest);
    const ImageF image = read_exr_channels(view.image)[0].image;
    double a = 0, b = 0, aa = 0, ab = 0, bb = 0;
    for (std::size_t i = 0; i < truth.size(); ++i) {
      const double x = std::log(static_cast<double>(truth.pixels()[i]) + 1e-3);
      const auto y = static_cast<double>(image.pixels()[i]);
      a += x, b += y, aa += x * x, ab += x * y, bb += y * y;
    }
    const auto n = static_cast<double>(truth.size());
    return (ab - a * b / n) / std::sqrt((aa - a * a / n) * (bb - b * b / n));
  }
};

TEST_F(ReconstructionModule, EquationsRecoverTheImage) {
  (void)run_reconstruction(request("best", kBest));
  EXPECT_GT(correlation("best"), 0.85);
  for (const char* file : {"image/image_00000000.exr", "image/image_00000000.png",
                           "gradient/gradient_00000000.exr", "run.yaml", "timing.json"})
    EXPECT_TRUE(fs::exists(path("best") / file)) << file;
}

TEST_F(ReconstructionModule, GradientFilterRecoversTheImageNotItsNegative) {
  (void)run_reconstruction(request("thesis", kThesis));
  EXPECT_GT(correlation("thesis"), 0.4);
}

/// True gradients in, image out; depth where it is known is the depth that is there.
TEST_F(ReconstructionModule, WritesTheFiguresOfTheThesis) {
  (void)run_reconstruction(request("figures", "{method: equations, figures: true}"));
  const fs::path figures = path("figures") / "figures";
  const auto channel = [](const fs::path& file, const std::string& name) {
    for (ExrChannel& c : read_exr_channels(file))
      if (c.name == name) return c.image;
    ADD_FAILURE() << name;
    return ImageF();
  };
  const ImageF frame = channel(figures / "poisson.exr", "L");
  const ImageF neumann = channel(figures / "poisson.exr", "neumann");
  for (std::size_t i = 0; i < frame.size(); ++i)
    ASSERT_NEAR(neumann.pixels()[i], frame.pixels()[i], 1e-3) << i;

  const RunView view = read_view_list(figures / "views.yaml").at(0);
  const ImageF truth = testing::corner_world(120, 90).depth(testing::corner_motion(view.t_s));
  std::size_t least = 0;
  for (const char* name : {"k01", "k03", "k07", "k15", "k25"}) {
    const ImageF depth = channel(view.depth, name);
    std::size_t known = 0, wrong = 0;
    for (std::size_t i = 0; i < depth.size(); ++i) {
      if (!(depth.pixels()[i] > 0)) continue;
      ++known;
      if (std::abs(depth.pixels()[i] / truth.pixels()[i] - 1) > 0.1F) ++wrong;
    }
    // Contours grow by half the kernel.
    if (std::string(name) == "k03") {
      EXPECT_LT(wrong, known / 10);
    }
    EXPECT_GE(known, least) << name;
    least = known;
  }
  EXPECT_GT(least, truth.size() * 9 / 10);
  EXPECT_FALSE(fs::exists(path("best") / "figures"));
}

TEST_F(ReconstructionModule, IsTheSameForAnyNumberOfThreads) {
  const std::string windows = "window: {duration_s: 0.1}, snapshot_events: [2000, 5000]";
  for (const int threads : {1, 2}) {
    set_thread_count(threads);
    (void)run_reconstruction(
        request("t" + std::to_string(threads), "{method: equations, " + windows + "}"));
  }
  set_thread_count(0);
  for (const char* file :
       {"image/image_00000000.exr", "image/image_00000002.exr", "gradient/gradient_00000001.exr",
        "growth/growth_000002000.png", "views.yaml"})
    EXPECT_EQ(read_file(path("t1") / file), read_file(path("t2") / file)) << file;
}

TEST_F(ReconstructionModule, TakesTheDepthOfARun) {
  RunRequest depth = request("depth", "window: {duration_s: 0.15}");
  (void)run_module("depth", depth);
  RunRequest run = request("with_depth", kBest);
  run.depth_from = path("depth");
  (void)run_module("reconstruct", run);
  EXPECT_GT(correlation("with_depth"), 0.75);
  EXPECT_THAT(read_file(path("with_depth") / "run.yaml"), HasSubstr("depth_from"));
}

TEST_F(ReconstructionModule, WithoutStatedThresholdsTheEventsAreBalanced) {
  const fs::path bare = path("unstated");
  fs::create_directories(bare);
  fs::copy(dataset(), bare, fs::copy_options::recursive);
  fs::remove(bare / "dataset.yaml");
  const Dataset recording = Dataset::open(bare);
  Events events;
  for (int i = 0; i < 30000; ++i)
    events.push_back({i, 0, 0, static_cast<std::int8_t>(i % 3 == 0 ? 1 : -1)});
  const ContrastThresholds found = contrast_thresholds({}, {}, recording, events);
  EXPECT_TRUE(found.is_found);
  EXPECT_NEAR(found.on / found.off, 2, 0.02);
  const ContrastThresholds one = contrast_thresholds({}, 0.3, recording, events);
  EXPECT_NEAR(one.on, 0.6, 0.006);
  EXPECT_DOUBLE_EQ(one.off, 0.3);
  EXPECT_FALSE(contrast_thresholds(0.1, 0.3, recording, events).is_found);
  EXPECT_NEAR(contrast_thresholds({}, {}, recording, {}).off, 0.2, 1e-12);

  RunRequest run = request("found", kBest);
  run.dataset = bare;
  const RunSummary summary = run_reconstruction(run);
  EXPECT_THAT(summary.found, HasSubstr("by the balance of the events"));
  EXPECT_TRUE(read_run_record(path("found") / "run.yaml").contrast);
  EXPECT_GT(correlation("found"), 0.8);
}

TEST_F(ReconstructionModule, RemovesTheBiasOfWhatPixelsMiss) {
  // Every eighth fall is missing, which tilts the image along the motion.
  int falls = 0;
  testing::write_corner_dataset(path("lossy"), "lossy", 0.3, 120, [&](const Event& event) {
    return event.polarity > 0 || ++falls % 8 != 0;
  });
  for (const std::string removed : {"false", "true"}) {
    RunRequest run = request("removed_" + removed,
                             "{method: equations, observations: {remove_bias: " + removed + "}}");
    run.dataset = path("lossy");
    (void)run_reconstruction(run);
  }
  EXPECT_GT(correlation("removed_true"), 0.8);
  EXPECT_GT(correlation("removed_true"), correlation("removed_false") + 0.1);
}

TEST_F(ReconstructionModule, BadInputIsAnErrorThatNamesItsSource) {
  RunRequest none = request("none", kBest);
  none.depth_from = dataset();
  EXPECT_THAT(error_of([&] { return run_reconstruction(none).events; }), HasSubstr("views.yaml"));
  RunRequest run = request("track", "{}");
  run.depth_from = dataset();
  EXPECT_THAT(error_of([&] { return run_module("track", run).events; }), HasSubstr("--depth-from"));
  const fs::path bare = path("bare");
  fs::create_directories(bare);
  fs::copy(dataset(), bare, fs::copy_options::recursive | fs::copy_options::overwrite_existing);
  fs::remove(bare / "depth.txt");
  RunRequest without = request("without", kBest);
  without.dataset = bare;
  EXPECT_THAT(error_of([&] { return run_reconstruction(without).events; }),
              HasSubstr("--depth-from"));
  EXPECT_FALSE(fs::exists(path("without")));
}

}  // namespace
}  // namespace saccade
