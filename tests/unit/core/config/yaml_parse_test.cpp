#include "core/config/yaml_parse.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "tests/support/error_of.h"

namespace saccade::config {
namespace {

using saccade::testing::error_of;

Node parse_text(const std::string& text) {
  return parse_yaml(text, std::make_shared<const Source>(Source{"a.yaml", {}}));
}

std::string parse_error(const std::string& text) {
  return error_of([&] { return parse_text(text); });
}

TEST(ParseYaml, KeepsPlacesOrderAndQuotes) {
  const Node root = parse_text("b: 1\na:\n  - x\n  - 'y'\nc:\n");
  ASSERT_EQ(root.entries.size(), 3U);
  EXPECT_EQ(root.entries[0].key, "b");
  EXPECT_EQ(root.entries[1].location.text(), "a.yaml:2");
  const Node& list = root.entries[1].value;
  EXPECT_EQ(list.items[1].location.text(), "a.yaml:4");
  EXPECT_FALSE(list.items[0].quoted);
  EXPECT_TRUE(list.items[1].quoted);
  EXPECT_EQ(root.entries[2].value.kind, Node::Kind::kNull);
  EXPECT_EQ(root.entries[2].value.location.text(), "a.yaml:5");
}

TEST(ParseYaml, EmptyTextIsNull) {
  EXPECT_EQ(parse_text("").kind, Node::Kind::kNull);
  EXPECT_EQ(parse_text("# only a comment\n").kind, Node::Kind::kNull);
}

TEST(ParseYaml, ExpandsAliases) {
  const Node root = parse_text("a: &v [1, 2]\nb: *v\n");
  EXPECT_EQ(root.find("b")->value.items.size(), 2U);
}

TEST(ParseYaml, NamesTheLineOfWhatIsNoYaml) {
  EXPECT_THAT(parse_error("a: 1\nb: [1, 2\n"), ::testing::StartsWith("a.yaml:"));
  EXPECT_THAT(parse_error("a: 1\nb: x: y\n"), ::testing::StartsWith("a.yaml:2: not valid YAML"));
  EXPECT_THAT(parse_error("a: 1\n\tb: 2\n"), ::testing::StartsWith("a.yaml:2: not valid YAML"));
  EXPECT_THAT(parse_error("a: *nowhere\n"), ::testing::StartsWith("a.yaml:1: not valid YAML"));
}

TEST(ParseYaml, NamesTheQuoteThatIsNeverClosed) {
  const std::string problem = "a.yaml:2: not valid YAML: a quote opens here and is never closed";
  EXPECT_EQ(parse_error("a: 1\nb: \"open\n\n"), problem);
  EXPECT_EQ(parse_error("a: 1\nb: 'it''s open\n"), problem);
  EXPECT_EQ(parse_error("a: 1\nb: &x \"open\\\"\n"), problem);
  EXPECT_EQ(parse_text("a: 'it''s'\n").find("a")->value.text, "it's");
  EXPECT_EQ(parse_text("a: &x \"q\\\"\"\n").find("a")->value.text, "q\"");
}

TEST(ParseYaml, FindsQuotesBehindAnyLineEndAndLetter) {
  for (const std::string start : {"", "\xef\xbb\xbf", "\xc3\xa9: 1\r\n", "# ''\xe2\x82\xac\n"}) {
    EXPECT_EQ(parse_text(start + "a: 'x'\r\nb: \"y\"\r\n").find("b")->value.text, "y");
    EXPECT_THAT(parse_error(start + "a: 'x'\r\nb: \"y\r\n"), ::testing::HasSubstr("never closed"));
  }
}

TEST(ParseYaml, RefusesWhatIsNoText) {
  EXPECT_EQ(parse_error("a: 1\nb: \x04\nc: 1\n"), "a.yaml:2: not a text file");
  EXPECT_EQ(parse_error(std::string("a: 1\n\0", 6)), "a.yaml:2: not a text file");
}

TEST(ParseYaml, RefusesWhatStandsBehindTheDocument) {
  EXPECT_EQ(parse_error("a: 1\n---\nb: 1\n"),
            "a.yaml:2: the document has ended before this; a configuration is one document");
  EXPECT_THAT(parse_error("{a: 1}\n}\n"), ::testing::StartsWith("a.yaml:2: "));
  EXPECT_THAT(parse_error(","), ::testing::StartsWith("a.yaml:1: "));
}

TEST(ParseYaml, RefusesDuplicateKeys) {
  EXPECT_EQ(parse_error("a: 1\nb: 2\n\na: 3\n"),
            "a.yaml:4: duplicate key 'a', first stated in line 1");
  EXPECT_EQ(parse_error("s:\n  a: 1\n  'a': 3\n"),
            "a.yaml:3: duplicate key 'a', first stated in line 2");
  EXPECT_EQ(parse_error("s: {a: 1, a: 3}\n"),
            "a.yaml:1: duplicate key 'a', first stated in line 1");
}

TEST(ParseYaml, RefusesWhatAConfigurationNeverNeeds) {
  EXPECT_EQ(parse_error("a: !!float 3\n"),
            "a.yaml:1: tags are not supported, found 'tag:yaml.org,2002:float'");
  EXPECT_EQ(parse_error("[1, 2]: 3\n"), "a.yaml:1: a key must be plain text");
}

TEST(ParseYaml, RefusesTreesWithoutEnd) {
  EXPECT_EQ(parse_error("a: &x [*x]\n"), "a.yaml:1: an alias inside of what it names");
  EXPECT_THAT(parse_error(std::string(5000, '[')), ::testing::StartsWith("a.yaml:1: "));
  std::string bomb = "a0: &a0 [1, 1, 1, 1, 1, 1, 1, 1, 1, 1]\n";
  for (int i = 1; i < 9; ++i) {
    const std::string last = "*a" + std::to_string(i - 1);
    const std::string name = "a" + std::to_string(i);
    bomb += name + ": &" + name + " [";
    for (int j = 0; j < 10; ++j) bomb += last + (j < 9 ? ", " : "]\n");
  }
  EXPECT_THAT(parse_error(bomb), ::testing::EndsWith("too many values"));
}

TEST(ParseYaml, LetsNoOtherExceptionOut) {
  const std::string alphabet = "ab1:-,[]{}\"'#&*!|>%@`?~ \n\t\\.\x01\xc3\xff";
  std::mt19937 random(7);
  for (int i = 0; i < 20000; ++i) {
    std::string text;
    for (std::size_t length = random() % 24; length > 0; --length)
      text += alphabet[random() % alphabet.size()];
    SCOPED_TRACE(::testing::PrintToString(text));
    EXPECT_NO_THROW(parse_error(text));
  }
}

}  // namespace
}  // namespace saccade::config
