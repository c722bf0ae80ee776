#include "estimator/run/run_input.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "core/io/dataset/dataset.h"
#include "tests/support/command.h"
#include "tests/support/error_of.h"

namespace saccade {
namespace {

using testing::error_of;
using ::testing::HasSubstr;

/// A recording of 1000 s, in megabytes of text that cannot be read to their end.
class EventWindowOfARun : public ::testing::Test {
 protected:
  EventWindowOfARun() {
    std::string events;
    for (int i = 0; i < 100'000; ++i)
      events += std::to_string(500 + i / 100) + "." + std::to_string(100 + i % 100) + " 3 4 1\n";
    folder_.write("events.txt", events + "no event\n");
    folder_.write("calib.txt", "200 200 119.5 89.5 0 0 0 0 0\n");
    folder_.write("camera.yaml",
                  "cam0:\n"
                  "  camera_model: pinhole\n"
                  "  intrinsics: [200, 200, 119.5, 89.5]\n"
                  "  distortion_model: none\n"
                  "  distortion_coeffs: []\n"
                  "  resolution: [240, 180]\n");
  }

  [[nodiscard]] Dataset dataset() const { return Dataset::open(folder_.path()); }

  testing::TemporaryFolder folder_;
  RunRequest request_;
};

TEST_F(EventWindowOfARun, ADurationAloneCountsFromTheFirstEventAndReadsNoFurther) {
  request_.duration_s = 2;
  EXPECT_EQ(event_window(request_, dataset()).end_ns, 502'100'000'000);
  const Events events = load_events(request_, dataset());
  EXPECT_EQ(events.size(), 200U);
  EXPECT_EQ(events.front().t_ns, 500'100'000'000);
}

TEST_F(EventWindowOfARun, AStartAndADurationAreTheirOwn) {
  request_.start_s = 510;
  request_.duration_s = 1;
  EXPECT_EQ(load_events(request_, dataset()).size(), 100U);
  request_.start_s = 10;
  EXPECT_THAT(error_of([&] { static_cast<void>(load_events(request_, dataset())); }),
              HasSubstr("holds no events in the window"));
}

TEST_F(EventWindowOfARun, WithoutAnEndAllIsRead) {
  request_.start_s = 510;
  EXPECT_THAT(error_of([&] { static_cast<void>(load_events(request_, dataset())); }),
              HasSubstr("events.txt:100001"));
  request_.start_s.reset();
  request_.duration_s = 1e300;
  EXPECT_EQ(event_window(request_, dataset()).end_ns, TimeWindow().end_ns);
}

}  // namespace
}  // namespace saccade
