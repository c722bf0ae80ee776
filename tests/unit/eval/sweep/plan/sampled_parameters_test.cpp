#include "eval/sweep/plan/sampled_parameters.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "core/config/convert.h"
#include "core/config/document.h"
#include "core/config/yaml_emit.h"
#include "tests/support/error_of.h"

namespace saccade {
namespace {

using testing::error_of;
using ::testing::HasSubstr;

SampledParameters parse_parameters(const std::string& yaml) {
  SampledParameters parameters;
  from_node(config::parse(yaml, "parameters.yaml").root(), "draw", parameters);
  return parameters;
}

std::string sampled(const SampledParameters& parameters, std::uint64_t index,
                    std::uint64_t seed = 1) {
  return config::to_flow_yaml(sample_values(parameters, seed, index));
}

double number(const SampledParameters& parameters, const char* key, std::uint64_t index) {
  return *config::number_of(sample_values(parameters, 1, index).find(key)->value);
}

TEST(SampledParameters, DependOnSeedIndexAndKeyAlone) {
  const SampledParameters one = parse_parameters("a: {uniform: [0, 1]}\n");
  const SampledParameters more = parse_parameters("b: {uniform: [0, 1]}\na: {uniform: [0, 1]}\n");
  EXPECT_EQ(number(one, "a", 417), number(more, "a", 417));
  EXPECT_NE(number(more, "a", 417), number(more, "b", 417));
  EXPECT_NE(number(one, "a", 417), number(one, "a", 418));
  EXPECT_NE(sampled(one, 417, 1), sampled(one, 417, 2));
}

TEST(SampledParameters, HaveTheirDistributions) {
  const SampledParameters parameters = parse_parameters(
      "u: {uniform: [2, 4]}\nl: {log_uniform: [1, 100]}\ni: {integer: [-1, 1]}\n"
      "n: {normal: [5, 2]}\nb: {normal: [0, 1, 0, 0.5]}\nc: {choose: [x, {y: 1}, {uniform: [0, "
      "1]}]}\n");
  constexpr int kCount = 4000;
  double u = 0, l = 0, n = 0, n2 = 0;
  std::map<double, int> whole;
  int chosen_x = 0;
  for (int i = 0; i < kCount; ++i) {
    const auto index = static_cast<std::uint64_t>(i);
    const double ui = number(parameters, "u", index), ni = number(parameters, "n", index);
    ASSERT_TRUE(ui >= 2 && ui <= 4);
    u += ui / kCount;
    l += std::log10(number(parameters, "l", index)) / kCount;
    n += ni / kCount;
    n2 += ni * ni / kCount;
    ++whole[number(parameters, "i", index)];
    const double b = number(parameters, "b", index);
    ASSERT_TRUE(b >= 0 && b <= 0.5);
    if (sampled(parameters, index).find("c: x") != std::string::npos) ++chosen_x;
  }
  // Five standard errors each.
  const double error = 5 / std::sqrt(kCount);
  EXPECT_NEAR(u, 3, error * 2 / std::sqrt(12));
  EXPECT_NEAR(l, 1, error * 2 / std::sqrt(12));
  EXPECT_NEAR(n, 5, error * 2);
  EXPECT_NEAR(std::sqrt(n2 - n * n), 2, error * 2);
  EXPECT_EQ(whole.size(), 3U);
  for (const auto& [value, count] : whole)
    EXPECT_NEAR(count, kCount / 3.0, error * kCount * std::sqrt(2.0 / 9)) << value;
  EXPECT_NEAR(chosen_x, kCount / 3.0, error * kCount * std::sqrt(2.0 / 9));
}

TEST(SampledParameters, StandAnywhereInAValue) {
  const SampledParameters parameters = parse_parameters(
      "trajectory: {source: shake, position: [1, {integer: [7, 7]}, 3]}\n"
      "on: {uniform: [0.1, 0.4]}\noff: {same_as: on}\n");
  EXPECT_THAT(sampled(parameters, 3), HasSubstr("{source: shake, position: [1, 7, 3]}"));
  EXPECT_EQ(number(parameters, "on", 3), number(parameters, "off", 3));
}

TEST(SampledParameters, RepeatMakesAListOfItsOwnSamples) {
  const SampledParameters parameters = parse_parameters(
      "a: {repeat: {count: {integer: [0, 3]}, item: {x: {uniform: [0, 1]}, kind: box}}}\n");
  std::map<std::size_t, int> lengths;
  for (std::uint64_t index = 0; index < 100; ++index) {
    const config::Node list = sample_values(parameters, 1, index).find("a")->value;
    ++lengths[list.items.size()];
    for (std::size_t k = 0; k < list.items.size(); ++k) {
      EXPECT_EQ(list.items[k].find("kind")->value.text, "box");
      const std::string x = list.items[k].find("x")->value.text;
      if (k > 0) {
        EXPECT_NE(x, list.items[0].find("x")->value.text);
      }
    }
  }
  EXPECT_EQ(lengths.size(), 4U);
  const auto error = [](const std::string& yaml) {
    return error_of([&] { return sample_values(parse_parameters(yaml), 1, 0).entries.size(); });
  };
  EXPECT_THAT(error("a: {repeat: {count: 2}}\n"), HasSubstr("must be {count: n, item: value}"));
  EXPECT_THAT(error("a: {repeat: {count: -1, item: 2}}\n"), HasSubstr("from 0 to 10000 times"));
}

TEST(SampledParameters, SayWhatIsWrongAndWhere) {
  const auto error = [](const std::string& yaml) {
    return error_of([&] { return parse_parameters("first: 1\n" + yaml).keys.entries.empty(); });
  };
  EXPECT_EQ(error("a.b: {uniform: [4, 2]}\n"),
            "parameters.yaml:2: draw.a.b.uniform is empty: 4 is not below 2");
  EXPECT_THAT(error("a: {uniform: 3}\n"), HasSubstr("parameters.yaml:2: draw.a.uniform"));
  EXPECT_THAT(error("a: {log_uniform: [0, 2]}\n"), HasSubstr("must be above 0"));
  EXPECT_THAT(error("a: {integer: [0, 2.5]}\n"), HasSubstr("whole numbers"));
  EXPECT_THAT(error("a: {normal: [0, 1, 9, 10]}\n"), HasSubstr("more than 3 sigma"));
  EXPECT_THAT(error("a: {normal: [0]}\n"), HasSubstr("[mean, sigma]"));
  EXPECT_THAT(error("a: [{choose: []}]\n"), HasSubstr("draw.a[0].choose holds nothing"));
  EXPECT_THAT(error("a: {same_as: b}\n"), HasSubstr("'b', which has no distribution here"));
  EXPECT_THAT(error("a: {same_as: a}\n"), HasSubstr("is the same as another key itself"));
  EXPECT_THAT(error("a: {unifrom: [1, 2]}\n"), HasSubstr("did you mean 'uniform'?"));
}

}  // namespace
}  // namespace saccade
