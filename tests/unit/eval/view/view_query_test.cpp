#include "eval/view/view_query.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <functional>
#include <string>

namespace saccade {
namespace {

using ::testing::HasSubstr;

int status_of(const std::function<void()>& ask) {
  try {
    ask();
  } catch (const BadRequest& refusal) {
    return refusal.status();
  }
  return 200;
}

int status_of_text(const std::string& target) {
  return status_of([&] { static_cast<void>(ViewQuery::parse(target)); });
}

TEST(ViewQuery, HasANameAndWholeNumbers) {
  ViewQuery query = ViewQuery::parse("events?start_us=-5&end_us=9007199254740993");
  EXPECT_EQ(query.name(), "events");
  EXPECT_EQ(query.number("start_us", -10, 10), -5);
  EXPECT_EQ(query.number("end_us", 0, INT64_MAX), 9007199254740993);
  EXPECT_EQ(query.number_or("every", 1, 9, 3), 3);
  EXPECT_NO_THROW(query.expect_all_read());
  EXPECT_EQ(ViewQuery::parse("sources").name(), "sources");
  EXPECT_EQ(ViewQuery::parse("").name(), "");
}

TEST(ViewQuery, RefusesEverythingElse) {
  for (const char* name :
       {"../../etc/passwd", "%2e%2e/x", "a/b", "Events", "a.b", "x\\y", "frame#1"})
    EXPECT_EQ(status_of_text(name), 404) << name;
  for (const char* parameters : {"x", "x=", "=1", "x=1.5", "x=1e3", "x= 1", "x=0x1", "x=+1",
                                 "x=%31", "x=99999999999999999999", "x=1;", "X=1", "x=1&x=1",
                                 "x=1&&y=2", "x=-", "x=../../a", "x=nan"})
    EXPECT_EQ(status_of_text(std::string("frame?") + parameters), 400) << parameters;
}

TEST(ViewQuery, ChecksRangesIndicesAndUnknownParameters) {
  const auto number = [](const std::string& target) {
    return status_of([&] { static_cast<void>(ViewQuery::parse(target).number("n", 1, 10)); });
  };
  EXPECT_EQ(number("a?n=1"), 200);
  EXPECT_EQ(number("a?n=10"), 200);
  EXPECT_EQ(number("a?n=0"), 400);
  EXPECT_EQ(number("a?n=11"), 400);
  EXPECT_EQ(number("a"), 400);
  const auto index = [](const std::string& target) {
    return status_of([&] { static_cast<void>(ViewQuery::parse(target).index("n", 3)); });
  };
  EXPECT_EQ(index("a?n=2"), 200);
  EXPECT_EQ(index("a?n=3"), 404);
  EXPECT_EQ(index("a?n=-1"), 404);
  EXPECT_EQ(index("a?n=9223372036854775807"), 404);
  EXPECT_EQ(index("a"), 400);
  try {
    ViewQuery::parse("a?other=1").expect_all_read();
    ADD_FAILURE() << "another parameter is taken";
  } catch (const BadRequest& refusal) {
    EXPECT_THAT(refusal.what(), HasSubstr("'other' is no parameter of 'a'"));
  }
}

TEST(ViewQuery, ATokenLeadsToThePageAlone) {
  const std::string token = "0123456789abcdef";
  EXPECT_EQ(behind_token("/0123456789abcdef/", token), "");
  EXPECT_EQ(behind_token("/0123456789abcdef/events?a=1", token), "events?a=1");
  for (const char* target :
       {"", "/", "//", "/0123456789abcdef", "/0123456789abcdee/", "/0123456789abcde/",
        "/0123456789abcdeff/", "0123456789abcdef/", "/0123456789ABCDEF/", "/../0123456789abcdef/",
        "/?token=0123456789abcdef", "http://127.0.0.1/0123456789abcdef/"})
    EXPECT_EQ(status_of([&] { static_cast<void>(behind_token(target, token)); }), 403) << target;
}

}  // namespace
}  // namespace saccade
