#pragma once

#include "core/image.h"

namespace saccade {

/// Colours of a picture. Events keep their meaning in both: ON green or blue-green, OFF red.
struct Theme {
  Rgb8 background;
  Rgb8 text;
  Rgb8 faint;  ///< axes, frames, missing values
  Rgb8 on;
  Rgb8 off;
  Rgb8 map;
  Rgb8 truth;
  Rgb8 estimate;
};

constexpr Theme kLightTheme{{255, 255, 255}, {28, 32, 38},    {214, 218, 224}, {0, 128, 96},
                            {214, 58, 48},   {118, 164, 255}, {120, 126, 134}, {214, 84, 20}};
constexpr Theme kDarkTheme{{12, 15, 20},  {226, 230, 236}, {52, 58, 68},    {70, 225, 110},
                           {240, 62, 52}, {36, 84, 230},   {150, 157, 168}, {255, 140, 60}};

/// Perceptual colour map for ordered quantities: 0 is dark violet, 1 a light yellow, lightness
/// grows evenly from one to the other (a path through OKLCh). `value` is clamped to [0, 1]; NaN is
/// 0.
[[nodiscard]] Rgb8 ordered_colour(double value);

/// a + weight (b - a) per channel of the 8-bit codes; `weight` 0..1.
[[nodiscard]] Rgb8 mix(const Rgb8& a, const Rgb8& b, double weight);

}  // namespace saccade
