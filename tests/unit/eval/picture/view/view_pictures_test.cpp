#include "eval/picture/view/view_pictures.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "core/io/images/exr_file.h"
#include "core/io/images/image_file.h"
#include "core/io/run/view_list.h"
#include "eval/picture/image/derotation_picture.h"
#include "eval/picture/render.h"
#include "eval/picture/view/reconstruction_stages.h"
#include "eval/report/sections/module_sections.h"
#include "tests/support/error_of.h"
#include "tests/support/planar_world.h"
#include "tests/unit/eval/fake_folders.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using testing::error_of;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::TemporaryFolder;

constexpr int kWidth = 80, kHeight = 60;
constexpr int kUpscale = 4;  // of pictures so wide that their captions fit into a line

/// Runs of depth and reconstruction over the corner, with the truth as their result.
class ViewPicturesTest : public testing::FakeFolders {
 protected:
  /// A view every 20 ms; `image`: of the log intensity, otherwise of the depth.
  fs::path write_run(const std::string& name, int count, bool image) {
    const fs::path run = folder.path() / name;
    fs::create_directories(run);
    const auto world = testing::corner_world(kWidth, kHeight);
    std::vector<RunView> views;
    for (int i = 0; i < count; ++i) {
      RunView view;
      view.t_s = 0.02 * (i + 1);
      view.world_from_camera = testing::corner_motion(view.t_s);
      const fs::path file = run / ("view_" + std::to_string(i) + ".exr");
      (image ? view.image : view.depth) = file;
      const ExrChannel channels[] = {
          {image ? "L" : "Z", image ? world.log_intensity(view.world_from_camera)
                                    : world.depth(view.world_from_camera)}};
      write_exr(file, channels);
      views.push_back(view);
    }
    write_view_list(run / "views.yaml", views);
    RunRecord record;
    record.module = image ? "reconstruct" : "depth";
    record.dataset = dataset();
    write_run_record(run / "run.yaml", record);
    return run;
  }

  void add_growth(const fs::path& run, const std::string& events) {
    fs::create_directories(run / "growth");
    write_png(run / "growth" / ("growth_" + events + ".png"), ImageU8(kWidth, kHeight, 90));
  }

  [[nodiscard]] ImageRgb8 sheet(const fs::path& run,
                                RenderOptions options = {.upscale = kUpscale}) {
    const fs::path picture = folder.path() / "sheet.png";
    render(run, picture, options);
    return read_image_rgb(picture);
  }

  TemporaryFolder folder;
};

int rows_of(const ImageRgb8& sheet) { return sheet.height() / (kUpscale * kHeight); }

TEST_F(ViewPicturesTest, ARowPerView) {
  for (const bool image : {false, true}) {
    const ImageRgb8 drawn = sheet(write_run(image ? "image" : "depth", 2, image));
    EXPECT_GT(drawn.width(), 4 * kUpscale * kWidth) << "events, result, truth, error";
    EXPECT_LT(drawn.width(), 5 * kUpscale * kWidth);
    EXPECT_EQ(rows_of(drawn), 2);
  }
}

TEST_F(ViewPicturesTest, AtMostSixRows) {
  const fs::path run = write_run("many", 9, false);
  EXPECT_LT(sheet(run).height(), 7 * (kUpscale * kHeight + 38) + 40);
  EXPECT_EQ(sheet(run).height(), sheet(write_run("six", 6, false)).height());
  EXPECT_EQ(rows_of(sheet(run, {.time_s = 0.1, .upscale = kUpscale})), 1);
  EXPECT_EQ(rows_of(sheet(run, {.start_s = 0.03, .duration_s = 0.04, .upscale = kUpscale})), 2);
  EXPECT_THAT(error_of([&] { return sheet(run, {.start_s = 0.021, .duration_s = 0.01}); }),
              HasSubstr("no view"));
}

TEST_F(ViewPicturesTest, WithoutTruthTheResultStandsAlone) {
  const Dataset data = Dataset::open(dataset());
  EstimatedView view;
  view.t_s = 7;
  view.points = {{{20, 20}, 2.0, {}}, {{40, 30}, 3.0, {}}};
  EXPECT_EQ(depth_pictures(view, data, 1, kDarkTheme).size(), 1U);
  view.t_s = 0.1;
  EXPECT_EQ(depth_pictures(view, data, 1, kDarkTheme).size(), 3U);
}

TEST_F(ViewPicturesTest, GrowthInOrderOfEvents) {
  const fs::path run = write_run("growing", 1, true);
  EXPECT_THAT(growth_steps(run), IsEmpty());
  add_growth(run, "1000000000");
  add_growth(run, "000020000");
  const std::vector<GrowthStep> steps = growth_steps(run);
  ASSERT_EQ(steps.size(), 2U);
  EXPECT_EQ(steps[0].events, 20000);
  EXPECT_EQ(steps[1].events, 1e9);
  add_growth(run, "last");
  EXPECT_THAT(error_of([&] { return growth_steps(run); }), HasSubstr("growth_last.png"));
}

TEST_F(ViewPicturesTest, FilmsOfViewsAndOfGrowth) {
  if (std::system("ffmpeg -version > /dev/null 2>&1") != 0) GTEST_SKIP() << "ffmpeg is not here";
  const fs::path run = write_run("film", 3, true);
  render(run, folder.path() / "views.mp4", {.upscale = 1});
  add_growth(run, "000020000");
  add_growth(run, "000040000");
  render(run, folder.path() / "growth.mp4", {.upscale = 1});
  EXPECT_GT(fs::file_size(folder.path() / "views.mp4"),
            fs::file_size(folder.path() / "growth.mp4"));
}

TEST(EvenlyChosen, FirstAndLastAreAmongThem) {
  EXPECT_THAT(evenly_spaced_indices(0, 6), IsEmpty());
  EXPECT_THAT(evenly_spaced_indices(1, 6), ElementsAre(0));
  EXPECT_THAT(evenly_spaced_indices(3, 6), ElementsAre(0, 1, 2));
  EXPECT_THAT(evenly_spaced_indices(11, 6), ElementsAre(0, 2, 4, 6, 8, 10));
}

TEST(DerotatedEvents, MeetWhereOneDirectionIsSeen) {
  const PinholeCamera camera{80, 60, 70, 70, 39.5, 29.5, {}};
  const auto turned = [](double t_s) {
    return Rigid3(Eigen::Quaterniond(Eigen::AngleAxisd(t_s, Eigen::Vector3d::UnitY())),
                  Eigen::Vector3d::Zero());
  };
  const Trajectory trajectory({{0, turned(0)}, {0.2, turned(0.2)}});
  Events events;
  for (int i = 0; i <= 20; ++i) {
    const double t_s = 0.01 * i;
    const Eigen::Vector3d ray = turned(t_s).inverse() * camera.ray({50, 30});
    const Eigen::Vector2d pixel = camera.project(ray);
    Event event;
    event.t_ns = ns_from_seconds(t_s);
    event.x = static_cast<std::uint16_t>(std::lround(pixel.x()));
    event.y = static_cast<std::uint16_t>(std::lround(pixel.y()));
    event.polarity = 1;
    events.push_back(event);
  }
  const auto near = [](const ImageF& counts) {
    float sum = 0;
    for (int y = 29; y <= 31; ++y)
      for (int x = 49; x <= 51; ++x) sum += counts(x, y);
    return sum;
  };
  EXPECT_GT(near(count_derotated_events(events, camera, trajectory, 0)), 20);
  EXPECT_LT(near(count_events(events, camera)), 6);
}

TEST_F(ViewPicturesTest, StepsAreDrawnWhereARunKeptThem) {
  const fs::path run = write_run("steps", 1, true);
  const Dataset data = Dataset::open(dataset());
  EXPECT_THAT(poisson_pictures(run, 2), IsEmpty());
  EXPECT_THAT(propagation_pictures(run, data, 2, kDarkTheme), IsEmpty());

  const auto world = testing::corner_world(kWidth, kHeight);
  RunView view;
  view.t_s = 0.1;
  view.world_from_camera = testing::corner_motion(view.t_s);
  view.depth = run / "figures" / "propagation.exr";
  const ImageF truth = world.depth(view.world_from_camera);
  ImageF doubled = truth;
  for (float& z : doubled.pixels()) z *= 2;
  const ExrChannel maps[] = {{"Z", truth}, {"k01", ImageF(kWidth, kHeight)}, {"k15", doubled}};
  fs::create_directories(run / "figures");
  write_exr(view.depth, maps);
  write_view_list(run / "figures" / "views.yaml", std::vector{view});
  const auto drawn = propagation_pictures(run, data, 2, kDarkTheme);
  ASSERT_EQ(drawn.size(), 4U);
  EXPECT_THAT(drawn[0].caption, HasSubstr("1 x 1 px: 0.0 % known"));
  EXPECT_THAT(drawn[1].caption, HasSubstr("15 x 15 px: 100.0 % known, 99."));
  EXPECT_THAT(drawn[2].caption, HasSubstr("surface: 100.0 % known, 0."));
  EXPECT_EQ(drawn[3].caption, "truth");

  const ImageF flat(kWidth, kHeight);
  std::vector<ExrChannel> steps;
  for (const char* name : {"L", "gx", "gy", "div", "neumann"}) steps.push_back({name, flat});
  write_exr(run / "figures" / "poisson.exr", steps);
  EXPECT_THAT(error_of([&] { return poisson_pictures(run, 1).size(); }), HasSubstr("dirichlet"));
  steps.push_back({"dirichlet", flat});
  write_exr(run / "figures" / "poisson.exr", steps);
  EXPECT_EQ(poisson_pictures(run, 1).size(), 8U);

  RunData shown;
  EXPECT_EQ(reconstruction_stage_section(shown), "");
  shown.run.folder = run;
  shown.data = data;
  EXPECT_THAT(reconstruction_stage_section(shown), HasSubstr("residual, dirichlet"));
  EXPECT_THAT(reconstruction_stage_section(shown), HasSubstr("15 x 15 px"));
}

}  // namespace
}  // namespace saccade
