#include "core/config/document.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/config/yaml_emit.h"
#include "tests/support/command.h"
#include "tests/support/error_of.h"

namespace saccade::config {
namespace {

using saccade::testing::error_of;
using saccade::testing::TemporaryFolder;
using ::testing::HasSubstr;

const Node& at(const Node& map, const std::string& key) { return map.find(key)->value; }

TEST(Load, IncludedFilesAreMergedAndKeepTheirPlaces) {
  const TemporaryFolder folder;
  folder.write("parts/camera.yaml", "camera:\n  width: 240\n  fx: 200\nlist: [1, 2, 3]\n");
  const auto file = folder.write(
      "main.yaml", "include: parts/camera.yaml\ncamera:\n  fx: 100\n  fy: 101\nlist: [4]\n");
  const Document document = load(file);
  EXPECT_EQ(to_yaml(document.root()), "camera:\n  width: 240\n  fx: 100\n  fy: 101\nlist: [4]\n");
  const Node& camera = at(document.root(), "camera");
  EXPECT_EQ(at(camera, "width").location.text(),
            (folder.path() / "parts/camera.yaml").string() + ":2");
  EXPECT_EQ(at(camera, "fx").location.text(), file.string() + ":3");
}

TEST(Load, LaterIncludesWinOverEarlierOnes) {
  const TemporaryFolder folder;
  folder.write("a.yaml", "x: 1\ny_m: 1\nz: 1\n");
  folder.write("b.yaml", "x: 2\ny_m: 2\n");
  const auto file = folder.write("main.yaml", "include: [a.yaml, b.yaml]\nx: 3\n");
  EXPECT_EQ(to_yaml(load(file).root()), "x: 3\ny_m: 2\nz: 1\n");
}

TEST(Load, NullTakesAnIncludedKeyBack) {
  const TemporaryFolder folder;
  folder.write("a.yaml", "trajectory: {source: file, file: a.txt}\n");
  const auto file = folder.write(
      "main.yaml", "include: a.yaml\ntrajectory: {source: circle, file: ~, radius_m: 1}\n");
  EXPECT_EQ(to_yaml(load(file).root()), "trajectory:\n  source: circle\n  radius_m: 1\n");
}

TEST(Load, AFileMayBeIncludedTwiceButNotByItself) {
  const TemporaryFolder folder;
  folder.write("base.yaml", "x: 1\n");
  folder.write("a.yaml", "include: base.yaml\n");
  folder.write("b.yaml", "include: base.yaml\n");
  EXPECT_EQ(to_yaml(load(folder.write("main.yaml", "include: [a.yaml, b.yaml]\n")).root()),
            "x: 1\n");

  folder.write("c.yaml", "x: 1\ninclude: d.yaml\n");
  folder.write("d.yaml", "\ninclude: ../" + folder.path().filename().string() + "/c.yaml\n");
  EXPECT_THAT(error_of([&] { return load(folder.path() / "c.yaml"); }),
              ::testing::AllOf(HasSubstr("d.yaml:2: include cycle"), HasSubstr("c.yaml")));
}

TEST(Load, NamesTheFileThatIsMissing) {
  const TemporaryFolder folder;
  const std::string none = (folder.path() / "none.yaml").string();
  EXPECT_EQ(error_of([&] { return load(none); }), none + ": no such file '" + none + "'");
  const auto file = folder.write("main.yaml", "x: 1\ninclude:\n  - none.yaml\n");
  EXPECT_EQ(error_of([&] { return load(file); }),
            file.string() + ":3: no such file '" + none + "'");
  EXPECT_THAT(error_of([&] { return load(folder.path()); }), HasSubstr("is a folder"));
}

TEST(Load, RefusesARootThatIsNoMap) {
  const auto error = [](const std::string& text) {
    return error_of([&] { return parse(text, "a.yaml"); });
  };
  EXPECT_EQ(error("- 1\n- 2\n"), "a.yaml:1: expected 'key: value' lines, got a list");
  EXPECT_EQ(error("\nsamples:500\n"),
            "a.yaml:2: expected 'key: value' lines, got 'samples:500'; a space must follow ':'");
  EXPECT_EQ(error("include: {a: b}\n"), "a.yaml:1: include: expected a path, got a map");
  EXPECT_EQ(error("include:\n"), "a.yaml:1: include: expected a path, got nothing");
}

TEST(Load, EmptyFilesStateNothing) {
  EXPECT_TRUE(parse("", "a.yaml").root().entries.empty());
  EXPECT_TRUE(parse("# nothing\n", "a.yaml").root().entries.empty());
  EXPECT_TRUE(Document::empty().root().entries.empty());
}

std::string overridden(const std::string& text, const std::vector<std::string>& overrides) {
  return to_yaml(parse(text, "a.yaml", {}, overrides).root());
}

TEST(Overrides, SetKeysAlongTheirPath) {
  EXPECT_EQ(overridden("a: {b: 1, c: 2}\n", {"a.b=5"}), "a:\n  b: 5\n  c: 2\n");
  EXPECT_EQ(overridden("", {"a.b.c=[1, 2]"}), "a:\n  b:\n    c: [1, 2]\n");
  EXPECT_EQ(overridden("a:\n", {"a.b=1"}), "a:\n  b: 1\n");
  EXPECT_EQ(overridden("m: [{file: x}, {file: y}]\n", {"m.1.file=z"}),
            "m:\n  - file: x\n  - file: z\n");
  EXPECT_EQ(overridden("v: [1, 2]\n", {"v.0=7"}), "v: [7, 2]\n");
  EXPECT_EQ(overridden("a: 1\n", {"a=2", "a=3"}), "a: 3\n");
  EXPECT_EQ(overridden("a: 1\nb: 2\n", {"a=~"}), "b: 2\n");
  EXPECT_EQ(overridden("a: {b: 1}\n", {"a={c: 2}"}), "a:\n  c: 2\n");
  EXPECT_EQ(overridden("", {"a=x=y"}), "a: \"x=y\"\n");
  EXPECT_EQ(to_yaml(Document::empty(std::vector<std::string>{"seed=3"}).root()), "seed: 3\n");
}

TEST(Overrides, StandAtTheirOwnPlace) {
  const std::vector<std::string> overrides{"a.b=5"};
  const Document document = parse("a: {b: 1, c: 2}\n", "a.yaml", {}, overrides);
  EXPECT_EQ(at(at(document.root(), "a"), "b").location.text(), "--set a.b");
  EXPECT_EQ(at(at(document.root(), "a"), "c").location.text(), "a.yaml:1");
}

TEST(Overrides, NameWhatIsWrong) {
  const auto error = [](const std::string& assignment) {
    return error_of([&] { return overridden("s: 1\nm: [{file: x}]\n", {assignment}); });
  };
  EXPECT_EQ(error("samples"), "--set samples: expected key.path=value");
  EXPECT_EQ(error("=3"), "--set =3: expected key.path=value");
  EXPECT_THAT(error("s="), HasSubstr("--set s: no value behind '='"));
  EXPECT_EQ(error("a..b=1"), "--set a..b: an empty key in 'a..b'");
  EXPECT_EQ(error("a.=1"), "--set a.: an empty key in 'a.'");
  EXPECT_EQ(error("s.x=1"), "--set s.x: cannot set 'x' in '1' (a.yaml:1)");
  EXPECT_EQ(error("m.file=1"), "--set m.file: 'file' is no list index (a.yaml:2 is a list)");
  EXPECT_EQ(error("m.1.file=1"),
            "--set m.1.file: there is no item 1, the list of a.yaml:2 has 1 (counted from 0)");
  EXPECT_THAT(error("s=[1"), HasSubstr("--set s: not valid YAML"));
  EXPECT_THAT(error("s={a: 1, a: 2}"), HasSubstr("--set s: duplicate key 'a'"));
}

TEST(Document, AValueOnOneLineIsTheSameValue) {
  const std::string text = "a: {b: [1, {c: ~, \"d e\": 'yes'}], f: \"it's\"}\ng: []\n";
  const std::string line = to_flow_yaml(parse(text, "a.yaml").root());
  EXPECT_EQ(line.find('\n'), std::string::npos);
  EXPECT_EQ(line, R"({a: {b: [1, {c: ~, "d e": "yes"}], f: "it's"}, g: []})");
  EXPECT_EQ(to_flow_yaml(parse(line, "line").root()), line);
}

TEST(Load, IncludesAreBounded) {
  const TemporaryFolder folder;
  for (int i = 0; i < 100; ++i)
    folder.write("chain" + std::to_string(i) + ".yaml",
                 "include: chain" + std::to_string(i + 1) + ".yaml\n");
  EXPECT_THAT(error_of([&] { return load(folder.path() / "chain0.yaml"); }),
              HasSubstr("is the 33th file of a chain of includes"));

  folder.write("twice0.yaml", "x: 1\n");
  for (int i = 1; i <= 26; ++i) {
    const std::string part = "twice" + std::to_string(i - 1) + ".yaml";
    folder.write("twice" + std::to_string(i) + ".yaml", "include: [" + part + ", " + part + "]\n");
  }
  EXPECT_THAT(error_of([&] { return load(folder.path() / "twice26.yaml"); }),
              HasSubstr("includes more than 256 files"));
}

TEST(Load, ManyKeysAreMergedWithoutComparingAllWithAll) {
  const TemporaryFolder folder;
  std::string text;
  for (int i = 0; i < 200'000; ++i) text += "key" + std::to_string(i) + ": 1\n";
  folder.write("base.yaml", text);
  const Document document = load(folder.write(
      "main.yaml", "include: base.yaml\nkey7: ~\nkey8: 2\n" + text.substr(text.find("key9:"))));
  EXPECT_EQ(document.root().entries.size(), 199'999U);
  EXPECT_EQ(document.root().find("key7"), nullptr);
  EXPECT_EQ(document.root().find("key8")->value.text, "2");
}

}  // namespace
}  // namespace saccade::config
