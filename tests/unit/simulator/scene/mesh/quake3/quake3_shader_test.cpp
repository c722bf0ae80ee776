#include "simulator/scene/mesh/quake3/quake3_shader.h"

#include <gmock/gmock.h>

#include <string>

namespace saccade {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

Quake3Shader shader(const std::string& body) {
  const auto shaders = parse_quake3_script("textures/a\n{\n" + body + "\n}\n");
  EXPECT_TRUE(shaders.contains("textures/a"));
  return shaders.begin()->second;
}

TEST(Quake3Shader, APictureBehindBakedLightCoversAll) {
  const Quake3Shader wall = shader(
      "  surfaceparm metalsteps // how steps sound\n"
      "  {\n    map $lightmap\n    rgbGen identity\n  }\n"
      "  {\n    map Textures/Wall/Brick.tga\n    blendFunc GL_DST_COLOR GL_ZERO\n  }");
  EXPECT_EQ(wall.picture, "textures/wall/brick.tga");
  EXPECT_EQ(wall.coverage, Quake3Coverage::kAll);
  EXPECT_FALSE(wall.is_clamped);
  EXPECT_THAT(wall.ignored, IsEmpty());
}

TEST(Quake3Shader, AnAlphaTestOrAFadeCutsOut) {
  EXPECT_EQ(shader("{\nmap grate.tga\nalphaFunc GE128\n}").coverage, Quake3Coverage::kWhereOpaque);
  EXPECT_EQ(shader("{\nclampmap decal.tga\nblendFunc blend\n}").coverage,
            Quake3Coverage::kWhereOpaque);
  EXPECT_TRUE(shader("{\nclampmap decal.tga\nblendFunc blend\n}").is_clamped);
  EXPECT_EQ(shader("{\nmap glow.tga\nblendFunc GL_SRC_ALPHA GL_ONE\n}").coverage,
            Quake3Coverage::kNone);
  EXPECT_EQ(shader("{\nmap grate.tga\nalphaFunc LT128\n}").coverage, Quake3Coverage::kAll);
}

TEST(Quake3Shader, WhatAddsOrFiltersLightIsLeftOut) {
  const Quake3Shader flame = shader("{\nanimMap 10 f1.tga f2.tga\nblendFunc add\n}");
  EXPECT_EQ(flame.coverage, Quake3Coverage::kNone);
  EXPECT_EQ(flame.picture, "f1.tga");
  EXPECT_THAT(flame.ignored,
              ElementsAre("motion of textures", "surfaces that add or filter light"));
  EXPECT_EQ(shader("{\nmap stain.tga\nblendfunc GL_ZERO GL_SRC_COLOR\n}").coverage,
            Quake3Coverage::kNone);
  // One and zero is as none.
  EXPECT_EQ(shader("{\nmap wall.tga\nblendfunc GL_ONE GL_ZERO\n}").coverage, Quake3Coverage::kAll);
}

TEST(Quake3Shader, SkiesFogAndSpritesAreLeftOut) {
  EXPECT_EQ(shader("surfaceparm sky\nskyparms env/x - -").coverage, Quake3Coverage::kNone);
  EXPECT_EQ(shader("surfaceparm nodraw").coverage, Quake3Coverage::kNone);
  EXPECT_THAT(shader("deformVertexes autosprite2\n{\nmap flame.tga\n}").ignored,
              ElementsAre("sprites that turn to the camera"));
}

TEST(Quake3Shader, AReflectionIsShownWhereNothingElseIs) {
  EXPECT_EQ(shader("{\nmap env.tga\ntcGen environment\n}\n"
                   "{\nmap steel.tga\nblendFunc blend\n}")
                .picture,
            "steel.tga");
  EXPECT_EQ(shader("{\nmap env.tga\ntcGen environment\n}\n"
                   "{\nmap steel.tga\nblendFunc blend\n}")
                .coverage,
            Quake3Coverage::kAll);
  EXPECT_EQ(shader("{\nmap env.tga\ntcGen environment\n}").picture, "env.tga");
}

TEST(Quake3Shader, ScaledTexturesAndTheEditorsPicture) {
  const Quake3Shader terrain = shader("{\nmap rock.tga\ntcMod scale 0.25 2\n}");
  EXPECT_EQ(terrain.uv_scale, Eigen::Vector2d(0.25, 2));
  EXPECT_EQ(shader("qer_editorimage textures/rock.tga").picture, "textures/rock.tga");
}

TEST(Quake3Shader, SlipsOfScriptsArePassedOver) {
  const auto shaders = parse_quake3_script(
      "textures/One { { map one.tga } }\n/* textures/no\n{\n}\n*/\n"
      "textures/one\n{\n{\nmap other.tga\n}\n}\n"
      "}\ntextures/two\n{\n{\nmap\nblendFunc\n}\n{\nmap two.tga");
  ASSERT_EQ(shaders.size(), 1U) << "the second one is not closed";
  EXPECT_EQ(shaders.at("textures/one").picture, "one.tga") << "the first of a name counts";
  EXPECT_TRUE(parse_quake3_script("").empty());
  EXPECT_TRUE(parse_quake3_script("/*").empty());
  EXPECT_TRUE(parse_quake3_script("{{{{}}}}}}}").empty());
}

}  // namespace
}  // namespace saccade
