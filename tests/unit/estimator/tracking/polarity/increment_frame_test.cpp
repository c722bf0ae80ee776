#include "estimator/tracking/polarity/increment_frame.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>

#include "core/random.h"

namespace saccade {
namespace {

constexpr float kStillDepth_m = 2;

PinholeCamera still_camera() {
  PinholeCamera camera;
  camera.width = 64;
  camera.height = 48;
  camera.fx = camera.fy = 60;
  camera.cx = 31.5;
  camera.cy = 23.5;
  return camera;
}

/// A wall before the camera, which stands still beside its map.
class StillWall {
 public:
  StillWall()
      : reference_{ImageF(64, 48, -1), ImageF(64, 48, kStillDepth_m), Rigid3()},
        map_(still_camera(), std::span(&reference_, 1), 0),
        view_(map_, 0) {
    view_.draw(Rigid3());
  }
  [[nodiscard]] const MapView& view() const { return view_; }

 private:
  ReferenceView reference_;
  IntensityMap map_;
  MapView view_;
};

ImageMotion moving_right(double speed_px) {
  Twist velocity = Twist::Zero();
  velocity(0) = -speed_px * static_cast<double>(kStillDepth_m) / still_camera().fx;
  return {still_camera(), velocity};
}

Event event(double t_s, int x, int y, int polarity) {
  return {ns_from_seconds(t_s), static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y),
          static_cast<std::int8_t>(polarity)};
}

double sum_of(const ImageF& image) {
  return std::accumulate(image.pixels().begin(), image.pixels().end(), 0.0);
}

TEST(IncrementFrame, SumsPolarities) {
  const StillWall scene;
  IncrementFrame frame(still_camera(), true);
  const Events events{event(0, 10, 12, 1), event(1, 10, 12, 1), event(2, 20, 12, -1)};
  for (int repeat = 0; repeat < 2; ++repeat) {
    frame.draw(events, 0, moving_right(0), scene.view());
    EXPECT_EQ(frame.image()(10, 12), 2) << "what was drawn before is replaced";
    EXPECT_EQ(frame.image()(20, 12), -1);
    EXPECT_EQ(sum_of(frame.image()), 1);
  }
}

TEST(IncrementFrame, EventsMoveToTheTimeOfTheFrame) {
  const StillWall scene;
  IncrementFrame frame(still_camera(), true);
  const Events events{event(0.1, 10, 12, 1)};
  frame.draw(events, ns_from_seconds(0.1625), moving_right(100), scene.view());
  EXPECT_NEAR(frame.image()(16, 12), 0.75, 1e-4);
  EXPECT_NEAR(frame.image()(17, 12), 0.25, 1e-4);
  EXPECT_NEAR(sum_of(frame.image()), 1, 1e-5);
  // What has left the image is not drawn.
  frame.draw(events, ns_from_seconds(1), moving_right(100), scene.view());
  EXPECT_EQ(sum_of(frame.image()), 0);
}

TEST(IncrementFrame, ATurnOfPolarityCountsTwice) {
  const StillWall scene;
  IncrementFrame frame(still_camera(), true);
  const Events before{event(0, 10, 12, 1)};
  const Events after{event(0.01, 10, 12, -1), event(0.02, 10, 12, -1)};
  frame.draw(before, 0, moving_right(0), scene.view());
  frame.draw(after, 0, moving_right(0), scene.view());
  EXPECT_EQ(frame.image()(10, 12), -3) << "the pixel remembers what it fired in the frame before";
  frame.reset();
  frame.draw(after, 0, moving_right(0), scene.view());
  EXPECT_EQ(frame.image()(10, 12), -2) << "it has forgotten";
  IncrementFrame plain(still_camera(), false);
  plain.draw(before, 0, moving_right(0), scene.view());
  plain.draw(after, 0, moving_right(0), scene.view());
  EXPECT_EQ(plain.image()(10, 12), -2);
}

TEST(IncrementFrame, TheFirstThresholdAfterATurnWasCrossedEarlier) {
  const StillWall scene;
  const auto moved_px = [&](double since_s) {
    IncrementFrame frame(still_camera(), true);
    const Events events{event(0, 10, 12, 1), event(since_s, 10, 12, -1)};
    frame.draw(std::span(events).first(1), 0, moving_right(100), scene.view());
    frame.draw(std::span(events).last(1), events[1].t_ns, moving_right(100), scene.view());
    double moment = 0;
    for (int x = 10; x < 20; ++x) moment -= (x - 10) * static_cast<double>(frame.image()(x, 12));
    return moment;
  };
  EXPECT_NEAR(moved_px(0.01), 0.3, 1e-3) << "0.3 of the time between, at 0.1 px/ms";
  EXPECT_NEAR(moved_px(1), 1.5, 1e-3) << "a long rest says nothing of when it began to move";
}

/// Events of a pixel whose log intensity is `amplitude` sin(2 pi t + phase), t in [0, 2].
Events fire(double amplitude, double phase, double contrast) {
  Events events;
  const auto signal = [&](double t) {
    return amplitude * std::sin(2 * std::numbers::pi * t + phase);
  };
  double level = signal(0);
  for (double t = 0; t < 2; t += 1e-4)
    while (std::abs(signal(t) - level) >= contrast) {
      const int polarity = signal(t) > level ? 1 : -1;
      level += polarity * contrast;
      events.push_back(event(t, 10, 12, polarity));
    }
  return events;
}

TEST(IncrementFrame, TurnsLeaveNoLagBehindTheSignal) {
  // The first moment of the increments over the second half of the wave, in which the signal falls
  // by twice the amplitude around t = 1.5: late events move it to later times.
  const StillWall scene;
  const Random random(4);
  constexpr double kAmplitude = 1;
  constexpr double kContrast = 0.15;
  constexpr double kSpeed_px = 20;
  constexpr std::uint64_t kWaves = 300;
  const auto lag_px = [&](bool reversals) {
    double moment = 0;
    for (std::uint64_t i = 0; i < kWaves; ++i) {
      // Half a wave that falls from 1.25 to 1.75, of pixels that began anywhere.
      const double level = random.uniform(0, i);
      const Events events = fire(kAmplitude + 0.1 * level, 0, kContrast);
      IncrementFrame frame(still_camera(), reversals);
      for (const Event& e : events) {
        const double t_s = seconds_from_ns(e.t_ns);
        frame.draw(std::span(&e, 1), ns_from_seconds(1.5), moving_right(kSpeed_px), scene.view());
        if (t_s < 1.25 || t_s > 1.78) continue;
        for (int x = 0; x < 64; ++x) moment += (10 - x) * static_cast<double>(frame.image()(x, 12));
      }
    }
    return -kContrast * moment / (2 * kAmplitude * kWaves);
  };
  EXPECT_GT(lag_px(false), 0.2);
  EXPECT_LT(std::abs(lag_px(true)), 0.5 * lag_px(false));
}

}  // namespace
}  // namespace saccade
