#include "simulator/sensor/pixel/pixel_bank.h"

namespace saccade {

PixelBank::PixelBank(const EventOptions& options, const PixelNoise& noise, std::uint64_t seed,
                     const Tile& tile)
    : options_(options), noise_(noise), pixels_(tile.pixels()) {
  for (std::size_t i = 0; i < pixels_.size(); ++i)
    pixels_[i].traits = pixel_traits(options, seed, static_cast<std::uint16_t>(tile.x(i)),
                                     static_cast<std::uint16_t>(tile.y(i)));
  if (noise.on()) noisy_.resize(pixels_.size());
}

void PixelBank::start(std::size_t i, double log_intensity, double t_s) {
  Pixel& pixel = pixels_[i];
  pixel.state = start_pixel(pixel.traits, log_intensity, t_s);
  update_thresholds(pixel);
  if (!noisy_.empty()) noisy_[i] = noise_.start(pixel.traits.x, pixel.traits.y, log_intensity, t_s);
}

void PixelBank::update_thresholds(Pixel& pixel) const {
  pixel.thresholds = Thresholds(pixel.state.reference.band(), pixel.traits.drift_per_s,
                                options_.log_eps, pixel.state.reference_s);
}

void PixelBank::save(StateWriter& state) const {
  for (const Pixel& pixel : pixels_) state.value(pixel.state);
  state.values(noisy_);
}

void PixelBank::load(StateReader& state) {
  for (Pixel& pixel : pixels_) {
    state.value(pixel.state);
    update_thresholds(pixel);
  }
  state.values(noisy_);
}

}  // namespace saccade
