#include "simulator/scene/mesh/relief.h"

#include <gmock/gmock.h>

#include <Eigen/Geometry>
#include <algorithm>

#include "core/config/config.h"
#include "core/error.h"
#include "simulator/scene/mesh/mesh_import.h"
#include "tests/unit/simulator/scene/mesh_files.h"

namespace saccade {
namespace {

using ::testing::HasSubstr;
using testing::MeshFiles;
using ::testing::ThrowsMessage;

ReliefOptions small_relief() {
  ReliefOptions options;
  options.size_m = {6, 4};
  options.triangles = 2400;
  return options;
}

ReliefOptions rippled_relief() {
  ReliefOptions options = small_relief();
  options.dunes.sharpness = 0.7;
  options.ripples.height_m = 0.02;
  return options;
}

void expect_slopes_of(const Relief& relief) {
  constexpr double kStep = 3e-6;
  for (double x = -2.9; x < 3; x += 0.173)
    for (double y = -1.9; y < 2; y += 0.191) {
      const auto height = [&](double dx, double dy) { return relief.at({x + dx, y + dy}).height; };
      const Eigen::Vector2d slope = relief.at({x, y}).slope;
      EXPECT_NEAR(slope.x(), (height(kStep, 0) - height(-kStep, 0)) / (2 * kStep), 1e-7);
      EXPECT_NEAR(slope.y(), (height(0, kStep) - height(0, -kStep)) / (2 * kStep), 1e-7);
    }
}

TEST(Relief, SlopeIsTheDerivativeOfTheHeight) {
  expect_slopes_of(Relief(small_relief()));
  expect_slopes_of(Relief(rippled_relief()));
}

TEST(Relief, SharpCrestsHaveAKinkWhereRoundOnesAreFlat) {
  ReliefOptions options = small_relief();
  options.swell.height_m = 0;
  options.dunes.bend_m = 0;
  options.dunes.height_m = 1;
  options.dunes.wavelength_m = 3;
  options.dunes.rise = 0.75;
  // Crests at 0.75 and 1.75 wavelengths from the lower corner at x = -3.
  constexpr double kCrest = -3 + 0.75 * 3;
  constexpr double kNear = 1e-7;
  const auto slope = [&](double x) { return Relief(options).at({x, 0}).slope.x(); };
  EXPECT_NEAR(slope(kCrest - kNear), slope(kCrest + kNear), 1e-5);
  options.dunes.sharpness = 1;
  const double height = Relief(options).at({kCrest, 0}).height;
  const double windward = slope(kCrest - kNear);
  const double lee = slope(kCrest + kNear);
  // The rise and fall of the crest's own height along the row is the same on both sides.
  EXPECT_NEAR(windward - lee, 2 * height / (0.75 * 3) + 2 * height / (0.25 * 3), 1e-4);
}

TEST(Relief, RipplesAreAddedToTheRest) {
  ReliefOptions options = small_relief();
  const Relief bare(options);
  options.ripples.height_m = 0.02;
  const Relief rippled(options);
  double low = 1;
  double high = 0;
  for (double x = -2.9; x < 3; x += 0.0171) {
    const double ripple = rippled.at({x, 0.3}).height - bare.at({x, 0.3}).height;
    low = std::min(low, ripple);
    high = std::max(high, ripple);
  }
  EXPECT_NEAR(low, 0, 1e-3);
  EXPECT_LE(high, 0.02);
  EXPECT_GT(high, 0.01);
}

TEST(Relief, SlopeNeverJumps) {
  const Relief relief(small_relief());
  constexpr double kStep = 1e-4;
  double largest = 0;
  Eigen::Vector2d last = relief.at({-3, 0.3}).slope;
  for (double x = -3 + kStep; x < 3; x += kStep) {
    const Eigen::Vector2d slope = relief.at({x, 0.3}).slope;
    largest = std::max(largest, (slope - last).norm());
    last = slope;
  }
  EXPECT_LT(largest, 30 * kStep);
}

TEST(Relief, HeightStaysWithinItsOptions) {
  ReliefOptions options = small_relief();
  options.dunes.height_m = 0.5;
  options.swell.height_m = 0.2;
  double low = 1;
  double high = -1;
  for (const Eigen::Vector3d& vertex : generate_relief(options).vertices) {
    low = std::min(low, vertex.z());
    high = std::max(high, vertex.z());
  }
  EXPECT_GE(low, -0.2);
  EXPECT_LE(high, 0.7);
  EXPECT_GT(high - low, 0.4);
}

TEST(Relief, TrianglesShareVerticesFaceUpAndCoverTheWhole) {
  const Mesh mesh = generate_relief(small_relief());
  EXPECT_NEAR(static_cast<double>(mesh.triangles.size()), 2400, 0.03 * 2400);
  EXPECT_LT(mesh.vertices.size(), 0.6 * static_cast<double>(mesh.triangles.size()));
  double area = 0;
  for (const Triangle& triangle : mesh.triangles) {
    const Eigen::Vector3d& a = mesh.vertices[triangle.corners[0]];
    const Eigen::Vector3d normal =
        (mesh.vertices[triangle.corners[1]] - a).cross(mesh.vertices[triangle.corners[2]] - a);
    EXPECT_GT(normal.z(), 0);
    EXPECT_GT(normal.normalized().dot(mesh.normals[triangle.corners[0]]), 0.8);
    area += 0.5 * normal.z();
  }
  EXPECT_NEAR(area, 24, 1e-9);
}

TEST(Relief, SurfaceDoesNotDependOnTheFineness) {
  ReliefOptions fine = small_relief();
  fine.triangles = 4 * fine.triangles;
  const Mesh coarse = generate_relief(small_relief());
  const Mesh finer = generate_relief(fine);
  const auto corner = [](const Mesh& mesh) { return mesh.vertices.back(); };
  EXPECT_EQ(corner(coarse), corner(finer));
  EXPECT_EQ(coarse.vertices.front(), finer.vertices.front());
}

TEST(Relief, RepeatsItselfAndFollowsItsSeed) {
  ReliefOptions other = small_relief();
  other.seed = 2;
  EXPECT_EQ(generate_relief(small_relief()).vertices, generate_relief(small_relief()).vertices);
  EXPECT_NE(generate_relief(small_relief()).vertices, generate_relief(other).vertices);
}

TEST(Relief, WithoutHeightsItIsFlat) {
  ReliefOptions options = small_relief();
  options.dunes.height_m = 0;
  options.swell.height_m = 0;
  for (const Eigen::Vector3d& vertex : generate_relief(options).vertices) EXPECT_EQ(vertex.z(), 0);
}

TEST(Relief, OptionsPrintWhatTheyRead) {
  const std::string printed = config::print(small_relief());
  const auto again = config::read<ReliefOptions>(config::parse(printed, "printed.relief.yaml"));
  EXPECT_EQ(config::print(again), printed);
}

class ReliefFiles : public MeshFiles {
 protected:
  Mesh read(const std::string& text) {
    return MeshImporter().read(write("ground.relief.yaml", text));
  }
};

TEST_F(ReliefFiles, AreReadLikeMeshes) {
  write("sand.texture.yaml", "size_m: [1, 1]\ntexels_per_m: 20\n");
  const Mesh mesh = read("size_m: [1, 1]\ntriangles: 200\ntexture: sand.texture.yaml\n");
  EXPECT_EQ(mesh.triangles.size(), 200U);
  ASSERT_NE(mesh.materials[0].texture, nullptr);
  EXPECT_EQ(mesh.materials[0].texture->width(), 20);
}

TEST_F(ReliefFiles, ATextureMayRepeat) {
  const Mesh once = read("size_m: [6, 3]\ntriangles: 200\n");
  EXPECT_EQ(once.uvs.back(), Eigen::Vector2d(1, 1));
  const Mesh mesh = read("size_m: [6, 3]\ntriangles: 200\ntexture_size_m: [2, 1.5]\n");
  EXPECT_EQ(mesh.uvs.front(), Eigen::Vector2d(0, 0));
  EXPECT_EQ(mesh.uvs.back(), Eigen::Vector2d(3, 2));
}

TEST_F(ReliefFiles, MistakesAreErrorsWithTheirPlace) {
  const auto fails = [&](const std::string& text, const std::string& message) {
    EXPECT_THAT([&] { static_cast<void>(read(text)); },
                ThrowsMessage<InputError>(HasSubstr(message)))
        << text;
  };
  fails("size_m: [0, 1]\n", "ground.relief.yaml:1: size_m");
  fails("seed: 1\ntriangles: 1\n", "ground.relief.yaml:2: triangles");
  fails("triangles: 1e9\n", "triangles");
  fails("texture: none.png\n", "no such file");
  fails("dunes: {across: [0, 0]}\n", "must not be zero");
  fails("dunes: {rise: 1}\n", "dunes.rise");
  fails("dunes: {sharpness: 2}\n", "dunes.sharpness");
  fails("ripples: {wavelength_m: 1e-6}\n", "at most 2048 times");
  fails("texture_size_m: [0, 1]\n", "texture_size_m");
  fails("swell: {wavelength_m: [2, 1]}\n", "must not fall");
  fails("swell: {wavelength_m: [1e-6, 1]}\n", "at most 2048 times");
  fails("dunes: {heigth_m: 1}\n", "did you mean 'height_m'");
  fails("size_m: [1, 1\n", "not valid YAML");
}

}  // namespace
}  // namespace saccade
