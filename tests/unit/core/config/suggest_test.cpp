#include "core/config/suggest.h"

#include <gtest/gtest.h>

#include <vector>

namespace saccade::config {
namespace {

TEST(EditDistance, CountsInsertionsDeletionsReplacementsAndSwaps) {
  EXPECT_EQ(edit_distance("samples", "samples"), 0U);
  EXPECT_EQ(edit_distance("sample", "samples"), 1U);
  EXPECT_EQ(edit_distance("xsamples", "samples"), 1U);
  EXPECT_EQ(edit_distance("sanples", "samples"), 1U);
  EXPECT_EQ(edit_distance("sampels", "samples"), 1U);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3U);
  EXPECT_EQ(edit_distance("", "abc"), 3U);
  EXPECT_EQ(edit_distance("Samples", "sAMPLES"), 0U);
}

TEST(Nearest, FindsWhatWasMeant) {
  const std::vector<std::string> keys{"samples", "scale", "rate_hz", "exposure_s"};
  EXPECT_EQ(nearest("sampels", keys), "samples");
  EXPECT_EQ(nearest("scal", keys), "scale");
  EXPECT_EQ(nearest("rate", keys), "rate_hz");
  EXPECT_EQ(nearest("exposure_us", keys), "exposure_s");
  EXPECT_EQ(nearest("SAMPLES", keys), "samples");
}

TEST(Nearest, IsSilentWhenNothingIsNear) {
  const std::vector<std::string> keys{"samples", "fx", "x"};
  EXPECT_EQ(nearest("background", keys), std::nullopt);
  EXPECT_EQ(nearest("cy", keys), std::nullopt);
  EXPECT_EQ(nearest("z", keys), std::nullopt);
  EXPECT_EQ(nearest("", keys), std::nullopt);
  EXPECT_EQ(nearest("samples", {}), std::nullopt);
}

TEST(Suggestion, NamesTheNearestOrAll) {
  const std::vector<std::string> verbs{"simulate", "run", "eval"};
  EXPECT_EQ(suggestion("simulte", verbs, "verbs"), "did you mean 'simulate'?");
  EXPECT_EQ(suggestion("paint", verbs, "verbs"), "valid verbs: simulate, run, eval");
  EXPECT_EQ(suggestion("paint", {}, "keys"), "there are no valid keys");
}

}  // namespace
}  // namespace saccade::config
