#include "estimator/registry.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>
#include <string>

#include "core/config/document.h"
#include "tests/support/command.h"
#include "tests/support/error_of.h"

namespace saccade {
namespace {

using testing::error_of;
using ::testing::HasSubstr;
using testing::TemporaryFolder;

TEST(Registry, FindsEveryModuleByItsName) {
  std::set<std::string> names;
  for (const Module& module : modules()) {
    EXPECT_EQ(&find_module(module.name), &module);
    EXPECT_TRUE(names.insert(module.name).second) << module.name << " stands twice";
    EXPECT_STRNE(module.help, "");
    EXPECT_EQ(std::string(module.help).find('\n'), std::string::npos);
  }
  EXPECT_TRUE(names.contains("track"));
}

TEST(Registry, UnknownNameListsTheModules) {
  for (const std::string& name : {std::string("trak"), std::string()}) {
    const std::string error = error_of([&] { return find_module(name).name; });
    EXPECT_THAT(error, HasSubstr("'" + name + "'"));
    for (const Module& module : modules()) EXPECT_THAT(error, HasSubstr(module.name));
  }
  EXPECT_THAT(error_of([] { return find_module("trak").name; }),
              HasSubstr("did you mean 'track'?"));
}

class EveryModule : public ::testing::TestWithParam<std::string> {
 protected:
  [[nodiscard]] const Module& module() const { return find_module(GetParam()); }
};

TEST_P(EveryModule, PrintsAConfigurationThatItReads) {
  const std::string printed = module().print_config(config::Document::empty());
  EXPECT_EQ(module().print_config(config::parse(printed, "printed")), printed);
  EXPECT_THAT(printed, HasSubstr("seed:"));
}

TEST_P(EveryModule, RefusesUnknownKeys) {
  const auto document = config::parse("{no_such_key: 1}", "t.yaml");
  EXPECT_THAT(error_of([&] { return module().print_config(document); }), HasSubstr("no_such_key"));
  const TemporaryFolder folder;
  RunRequest request;
  request.dataset = folder.path();
  request.output = folder.path() / "run";
  request.config = document;
  EXPECT_THAT(error_of([&] { return module().run(request); }), HasSubstr("no_such_key"));
  EXPECT_FALSE(std::filesystem::exists(request.output));
}

TEST_P(EveryModule, AnAbsentDatasetIsAnInputError) {
  const TemporaryFolder folder;
  RunRequest request;
  request.dataset = folder.path() / "absent";
  request.output = folder.path() / "run";
  EXPECT_THAT(error_of([&] { return run_module(GetParam(), request); }), HasSubstr("absent"));
  EXPECT_FALSE(std::filesystem::exists(request.output)) << "nothing half-made is left";
}

TEST_P(EveryModule, ImpossibleRequestsAreInputErrors) {
  const TemporaryFolder folder;
  RunRequest request;
  request.dataset = folder.path();
  request.output = folder.path() / "run";
  request.repeat = 0;
  EXPECT_THAT(error_of([&] { return module().run(request); }), HasSubstr("--repeat"));
  request.repeat = 1;
  for (const double duration : {0.0, -1.0}) {
    request.duration_s = duration;
    EXPECT_THAT(error_of([&] { return module().run(request); }), HasSubstr("--duration-s"));
  }
}

std::vector<std::string> names() {
  std::vector<std::string> names;
  for (const Module& module : modules()) names.emplace_back(module.name);
  return names;
}

INSTANTIATE_TEST_SUITE_P(Modules, EveryModule, ::testing::ValuesIn(names()),
                         [](const auto& test) { return test.param; });

}  // namespace
}  // namespace saccade
