#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/config/config.h"

namespace saccade::config::testing {

enum class Source { kFile, kCircle };

struct Blur {
  double sigma_px = 1.0;
  bool separable = true;
};

struct Mesh {
  std::filesystem::path file;
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();
};

/// One key of every type.
struct Options {
  bool verbose = false;
  int samples = 500;
  std::int64_t big = -1;
  std::uint64_t seed = 1;
  double ratio = 0.4;
  float gain = 0.1F;
  std::string name = "plain";
  std::filesystem::path output;
  Source source = Source::kFile;
  std::filesystem::path file;
  double radius_m = 2.0;
  std::array<double, 5> distortion{};
  std::vector<std::vector<double>> control_poses;
  std::vector<std::string> words;
  std::optional<double> duration_s;
  std::map<std::string, std::vector<std::string>> grid;
  double near_m = 1.0;
  double far_m = 2.0;
  Blur blur;
  std::optional<Blur> extra_blur;
  std::vector<Mesh> meshes;
  std::string embedded = "{}\n";
};

inline void describe(Fields& fields, Blur& blur) {
  fields.value("sigma_px", blur.sigma_px, "standard deviation").above(0);
  fields.value("separable", blur.separable, "rows, then columns");
}

inline void describe(Fields& fields, Mesh& mesh) {
  fields.path("file", mesh.file, "the mesh").required();
  fields.value("translation", mesh.translation, "where it stands, m").range(-10, 10);
}

inline void describe(Fields& fields, Options& options) {
  fields.value("verbose", options.verbose, "a switch");
  fields.value("samples", options.samples, "points per iteration").range(6, 1e6);
  fields.value("big", options.big, "a large number");
  fields.value("seed", options.seed, "of all random numbers");
  fields.value("ratio", options.ratio, "a fraction").above(0).at_most(1);
  fields.value("gain", options.gain, "a factor").at_least(0.1).below(10);
  fields.value("name", options.name, "a text");
  fields.path("output", options.output, "a path");
  fields.choice("source", options.source, {{"file", Source::kFile}, {"circle", Source::kCircle}},
                "where poses come from");
  if (options.source == Source::kFile) fields.path("file", options.file, "the poses").must_exist();
  if (options.source == Source::kCircle)
    fields.value("radius_m", options.radius_m, "of the circle");
  fields.value("distortion", options.distortion, "k1 k2 p1 p2 k3");
  fields.value("control_poses", options.control_poses, "t x y z qx qy qz qw").item_length(7, 8);
  fields.value("words", options.words, "some words").one_of({"alpha", "beta"}).length(0, 2);
  fields.value("duration_s", options.duration_s, "default: the whole").above(0);
  fields.value("grid", options.grid, "values per key");
  fields.group(
      "limits",
      [&](Fields& limits) {
        limits.value("near_m", options.near_m, "nearest depth").above(0);
        limits.value("far_m", options.far_m, "farthest depth");
        limits.expect(options.near_m < options.far_m, "near_m", "must be below far_m");
      },
      "range of depths");
  fields.section("blur", options.blur, "of the template");
  fields.section("extra_blur", options.extra_blur, "a second one");
  fields.list("meshes", options.meshes, "what stands in the scene");
  fields.embed("embedded", options.embedded, "another program's");
}

}  // namespace saccade::config::testing
