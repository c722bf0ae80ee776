#include "simulator/scene/mesh/relief.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/config/config.h"
#include "core/random.h"

namespace saccade {
namespace {

constexpr double kMaxTriangles = 4e6;
constexpr double kMaxWaves = 2048;

/// Who draws random numbers; the octaves of the swell follow from kSwell on.
enum ReliefStream : std::uint64_t { kDunes = 0, kRipples = 2, kSwell = 16 };

/// A function of one variable and its derivative.
struct Slope {
  double value, derivative;
};

/// From 0 at t = 0 to 1 at t = 1; the first two derivatives vanish at both ends.
Slope fade(double t) {
  return {t * t * t * (t * (6 * t - 15) + 10), 30 * t * t * (t - 1) * (t - 1)};
}

/// The same with the slope 2 and no curvature at t = 1.
Slope fade_to_kink(double t) { return {t * t * t * (2 - t), t * t * (6 - 4 * t)}; }

/// One period of a row: up over the first `rise` of it, down over the rest.
Slope profile(double phase, const ReliefOptions::Rows& rows) {
  const double t = phase - std::floor(phase);
  const bool rising = t < rows.rise;
  const double length = rising ? rows.rise : rows.rise - 1;
  const double along = rising ? t / rows.rise : (1 - t) / (1 - rows.rise);
  const Slope round = fade(along);
  const Slope sharp = fade_to_kink(along);
  return {round.value + rows.sharpness * (sharp.value - round.value),
          (round.derivative + rows.sharpness * (sharp.derivative - round.derivative)) / length};
}

ReliefOptions checked(const ReliefOptions& options) {
  config::check(options);
  return options;
}

void expect_few_waves(config::Fields& fields, std::string_view key, double side,
                      double wavelength_m) {
  fields.expect(side / wavelength_m <= kMaxWaves, key, "must fit at most 2048 times into size_m");
}

/// `side`: the longer side of the relief.
void describe_rows(config::Fields& fields, ReliefOptions::Rows& rows, double side) {
  fields
      .value("height_m", rows.height_m,
             "Height of the highest crests above the troughs, in metres. 0 leaves the rows out.")
      .at_least(0);
  fields.value("across", rows.across, "Direction from crest to crest; its length does not matter.")
      .range(-1e6, 1e6);
  fields.expect(rows.across[0] != 0 || rows.across[1] != 0, "across", "must not be zero");
  fields.value("wavelength_m", rows.wavelength_m, "Distance from crest to crest, in metres.")
      .above(0);
  expect_few_waves(fields, "wavelength_m", side, rows.wavelength_m);
  fields.value("rise", rows.rise, "Fraction of a wavelength on the gentle side of a row.")
      .range(0.05, 0.95);
  fields
      .value("sharpness", rows.sharpness,
             "Form of the crests. 0: they are round; 1: two straight slopes meet at them, as at "
             "the slip face of a dune.")
      .range(0, 1);
  fields
      .value("bend_m", rows.bend_m,
             "Largest displacement of the crests from straight lines, in metres.")
      .at_least(0);
  fields
      .value("bend_wavelength_m", rows.bend_wavelength_m,
             "Wavelength of that displacement and of the crests' height, in metres.")
      .above(0);
  expect_few_waves(fields, "bend_wavelength_m", side, rows.bend_wavelength_m);
}

}  // namespace

void describe(config::Fields& fields, ReliefOptions& options) {
  fields.value("size_m", options.size_m, "Size along x and y, in metres.").above(0);
  fields
      .value("triangles", options.triangles,
             "Approximate number of triangles; the shape does not depend on it.")
      .range(2, kMaxTriangles);
  fields
      .value("seed", options.seed,
             "Seed; another seed gives another relief with the same statistics.")
      .at_least(0);
  fields.path("texture", options.texture, "Picture or *.texture.yaml that covers the whole relief.")
      .must_exist();
  fields
      .value("texture_size_m", options.texture_size_m,
             "Size of the texture along x and y, in metres; it repeats over the relief. Default: "
             "that of the relief.")
      .above(0);
  fields.value("albedo", options.albedo, "Albedo without a texture, in linear light.").range(0, 1);
  const double side = std::max(options.size_m[0], options.size_m[1]);
  fields.group(
      "dunes", [&](config::Fields& group) { describe_rows(group, options.dunes, side); },
      "Rows of dunes whose crests bend, rise and sink.");
  fields.group(
      "swell",
      [&](config::Fields& group) {
        auto& swell = options.swell;
        group
            .value("height_m", swell.height_m,
                   "Largest height of the swell, in metres. 0 disables the swell.")
            .at_least(0);
        group
            .value("wavelength_m", swell.wavelength_m,
                   "Shortest and longest wavelength of the swell, in metres.")
            .above(0);
        group.expect(swell.wavelength_m[0] <= swell.wavelength_m[1], "wavelength_m",
                     "must not fall: the smaller number comes first");
        expect_few_waves(group, "wavelength_m", side, swell.wavelength_m[0]);
      },
      "Smooth bumps of many sizes.");
  fields.group(
      "ripples", [&](config::Fields& group) { describe_rows(group, options.ripples, side); },
      "Ripples that the wind leaves on the dunes: rows like theirs, but small. By default there "
      "are "
      "none.");
}

ReliefOptions read_relief_options(const std::filesystem::path& file) {
  return config::read<ReliefOptions>(config::load(file));
}

SmoothNoise::SmoothNoise(std::uint64_t seed, std::uint64_t stream, const Eigen::Vector2d& size,
                         double wavelength_m)
    : frequency_(1 / wavelength_m),
      columns_(static_cast<int>(size.x() * frequency_) + 2),
      rows_(static_cast<int>(size.y() * frequency_) + 2) {
  const Random random(seed);
  values_.resize(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
  for (std::size_t i = 0; i < values_.size(); ++i) values_[i] = 2 * random.uniform(stream, i) - 1;
}

Elevation SmoothNoise::at(const Eigen::Vector2d& point) const {
  const double x = point.x() * frequency_;
  const double y = point.y() * frequency_;
  const int i = std::clamp(static_cast<int>(x), 0, columns_ - 2);
  const int j = std::clamp(static_cast<int>(y), 0, rows_ - 2);
  const Slope fx = fade(x - i);
  const Slope fy = fade(y - j);
  const double* row = &values_[static_cast<std::size_t>(j * columns_ + i)];
  const double* next = row + columns_;
  const double across = row[1] - row[0];
  const double next_across = next[1] - next[0];
  const double low = row[0] + fx.value * across;
  const double high = next[0] + fx.value * next_across;
  return {low + fy.value * (high - low),
          frequency_ * Eigen::Vector2d(fx.derivative * (across + fy.value * (next_across - across)),
                                       fy.derivative * (high - low))};
}

CrestRows::CrestRows(const ReliefOptions::Rows& options, std::uint64_t seed, std::uint64_t stream,
                     const Eigen::Vector2d& size)
    : options_(options),
      across_(Eigen::Vector2d(options.across[0], options.across[1]).normalized()),
      bend_(seed, stream, size, options.bend_wavelength_m),
      crest_(seed, stream + 1, size, options.bend_wavelength_m) {}

Elevation CrestRows::at(const Eigen::Vector2d& point) const {
  const Elevation bend = bend_.at(point);
  const Elevation crest = crest_.at(point);
  const double phase = (across_.dot(point) + options_.bend_m * bend.height) / options_.wavelength_m;
  const Eigen::Vector2d phase_slope =
      (across_ + options_.bend_m * bend.slope) / options_.wavelength_m;
  const Slope shape = profile(phase, options_);
  const double height = options_.height_m * (0.75 + 0.25 * crest.height);
  return {height * shape.value, height * shape.derivative * phase_slope +
                                    0.25 * options_.height_m * shape.value * crest.slope};
}

Relief::Relief(const ReliefOptions& options)
    : size_(checked(options).size_m[0], options.size_m[1]),
      dunes_(options.dunes, options.seed, kDunes, size_) {
  const auto& [shortest, longest] = options.swell.wavelength_m;
  double total = 0;
  for (double length = longest; length >= shortest; length /= 2) {
    swell_.push_back({SmoothNoise(options.seed, kSwell + swell_.size(), size_, length), length});
    total += length;
  }
  for (Octave& octave : swell_) octave.height_m *= options.swell.height_m / total;
  if (options.ripples.height_m > 0)
    ripples_.emplace(options.ripples, options.seed, kRipples, size_);
}

Elevation Relief::at(const Eigen::Vector2d& point) const {
  const Eigen::Vector2d from_corner = point + 0.5 * size_;
  Elevation sum = dunes_.at(from_corner);
  const auto add = [&sum](const Elevation& part, double factor) {
    sum.height += factor * part.height;
    sum.slope += factor * part.slope;
  };
  for (const Octave& octave : swell_) add(octave.noise.at(from_corner), octave.height_m);
  if (ripples_) add(ripples_->at(from_corner), 1);
  return sum;
}

Mesh generate_relief(const ReliefOptions& options, std::shared_ptr<const Texture> texture) {
  const Relief relief(options);
  const auto& [width, height] = options.size_m;
  const double cells = 0.5 * static_cast<double>(options.triangles);
  const auto columns = static_cast<std::uint32_t>(
      std::clamp(std::round(std::sqrt(cells * width / height)), 1.0, cells));
  const auto rows = static_cast<std::uint32_t>(std::max(std::round(cells / columns), 1.0));

  const auto [tile_width, tile_height] = options.texture_size_m.value_or(options.size_m);
  const Eigen::Vector2d repeats(width / tile_width, height / tile_height);

  Mesh mesh;
  mesh.materials.push_back({options.albedo, std::move(texture), 1, nullptr});
  const std::size_t vertices = (std::size_t{columns} + 1) * (std::size_t{rows} + 1);
  mesh.vertices.reserve(vertices);
  mesh.normals.reserve(vertices);
  mesh.uvs.reserve(vertices);
  mesh.triangles.reserve(2 * std::size_t{columns} * std::size_t{rows});
  for (std::uint32_t j = 0; j <= rows; ++j)
    for (std::uint32_t i = 0; i <= columns; ++i) {
      const Eigen::Vector2d uv(static_cast<double>(i) / columns, static_cast<double>(j) / rows);
      const Eigen::Vector2d ground((uv.x() - 0.5) * width, (uv.y() - 0.5) * height);
      const Elevation elevation = relief.at(ground);
      mesh.vertices.emplace_back(ground.x(), ground.y(), elevation.height);
      mesh.normals.push_back(
          Eigen::Vector3d(-elevation.slope.x(), -elevation.slope.y(), 1).normalized());
      mesh.uvs.push_back(uv.cwiseProduct(repeats));
    }
  for (std::uint32_t j = 0; j < rows; ++j)
    for (std::uint32_t i = 0; i < columns; ++i) {
      const std::uint32_t corner = j * (columns + 1) + i;
      const std::uint32_t above = corner + columns + 1;
      mesh.triangles.push_back({{corner, corner + 1, above + 1}, 0});
      mesh.triangles.push_back({{corner, above + 1, above}, 0});
    }
  return mesh;
}

}  // namespace saccade
