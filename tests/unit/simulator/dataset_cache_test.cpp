#include "simulator/dataset_cache.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <fstream>
#include <sstream>

#include "core/config/config.h"
#include "core/io/files/file_lock.h"
#include "core/process/progress.h"
#include "tests/support/closed_form_plane.h"
#include "tests/support/command.h"
#include "tests/support/error_of.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using testing::ClosedFormPlane;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

/// A tenth of a second of a textured plane and an empty cache.
class Cache : public ::testing::Test {
 protected:
  void SetUp() override {
    set_progress_quiet(true);
    plane_.duration_s = 0.1;
    mesh_ = plane_.write_mesh(folder_.path());
  }
  void TearDown() override { set_progress_quiet(false); }

  [[nodiscard]] SimulationConfig config(int seed = 1) const {
    std::ostringstream yaml;
    yaml << "scene: {meshes: [{file: " << mesh_ << "}]}\n"
         << "trajectory:\n  source: waypoints\n  waypoints:\n"
         << "    - [0, 0, 0, 0, 0, 0, 0, 1]\n    - [0.1, 0.01, 0, 0, 0, 0, 0, 1]\n"
         << "camera: {width: 31, height: 23, fx: 50, fy: 50}\nseed: " << seed << "\n";
    return config::read<SimulationConfig>(config::parse(yaml.str(), "test.yaml", folder_.path()));
  }
  [[nodiscard]] DatasetCache cache() const { return DatasetCache(folder_.path() / "cache"); }
  [[nodiscard]] fs::path entry(const std::string& key) const {
    return folder_.path() / "cache/datasets" / key;
  }
  /// As if it had been asked for `days` ago.
  void age(const std::string& key, int days) const {
    fs::last_write_time(entry(key) / "lock",
                        fs::file_time_type::clock::now() - std::chrono::hours(24 * days));
  }

  testing::TemporaryFolder folder_;
  ClosedFormPlane plane_ = ClosedFormPlane::smooth(31, 23);
  fs::path mesh_;
};

TEST_F(Cache, NothingIsSimulatedTwice) {
  const DatasetCache::Obtained first = cache().obtain(config(), "plane");
  EXPECT_TRUE(first.report.has_value());
  EXPECT_TRUE(fs::exists(first.folder / "events.h5") || fs::exists(first.folder / "events.txt"));
  const DatasetCache::Obtained again = cache().obtain(config(), "other_name");
  EXPECT_FALSE(again.report.has_value());
  EXPECT_EQ(again.folder, first.folder);
  EXPECT_TRUE(cache().obtain(config(2), "plane").report.has_value());
  EXPECT_THAT(cache().list(), SizeIs(2));
}

TEST_F(Cache, LeavesAloneWhatItDidNotMake) {
  (void)cache().obtain(config(), "plane");
  const fs::path datasets = entry("");
  fs::create_directories(datasets / "photos");
  std::ofstream(datasets / "photos/lock") << "of another program";
  fs::create_directories(datasets / "0123456789abcdef");
  std::ofstream(datasets / "0123456789abcdef/letter.txt") << "without a lock";
  const testing::TemporaryFolder elsewhere;
  std::ofstream(elsewhere.path() / "lock") << "";
  std::ofstream(elsewhere.path() / "letter.txt") << "behind a link";
  fs::create_directory_symlink(elsewhere.path(), datasets / "fedcba9876543210");
  PruneOptions all;
  all.all = true;
  EXPECT_THAT(cache().prune(all), SizeIs(1));
  EXPECT_TRUE(fs::exists(datasets / "photos/lock"));
  EXPECT_TRUE(fs::exists(datasets / "0123456789abcdef/letter.txt"));
  EXPECT_TRUE(fs::exists(elsewhere.path() / "letter.txt"));
}

TEST_F(Cache, AChangedSceneFileIsAnotherDataset) {
  const std::string before = simulation_key(config());
  EXPECT_EQ(before, simulation_key(config()));
  EXPECT_THAT(before, SizeIs(16));
  std::ofstream(mesh_, std::ios::app) << "# a comment\n";
  EXPECT_NE(before, simulation_key(config()));
}

TEST_F(Cache, PrunesByAgeAndSize) {
  for (const int seed : {1, 2, 3}) {
    (void)cache().obtain(config(seed), "plane");
    age(simulation_key(config(seed)), 10 * seed);
  }
  const double gb = 1e-9 * static_cast<double>(cache().list().front().bytes);
  PruneOptions options;
  options.older_than_days = 25;
  options.dry_run = true;
  EXPECT_THAT(cache().prune(options), SizeIs(1));
  EXPECT_THAT(cache().list(), SizeIs(3));
  options.dry_run = false;
  EXPECT_EQ(cache().prune(options).at(0).key, simulation_key(config(3)));
  EXPECT_FALSE(fs::exists(entry(simulation_key(config(3)))));
  PruneOptions by_size;
  by_size.keep_gb = 1.5 * gb;
  EXPECT_EQ(cache().prune(by_size).at(0).key, simulation_key(config(2)));
  EXPECT_THAT(cache().list(), SizeIs(1));
  PruneOptions all;
  all.all = true;
  EXPECT_THAT(cache().prune(all), SizeIs(1));
  EXPECT_THAT(cache().list(), IsEmpty());
  EXPECT_TRUE(cache().obtain(config(), "plane").report.has_value());
}

TEST_F(Cache, WhatIsBeingSimulatedStays) {
  (void)cache().obtain(config(), "plane");
  const FileLock busy = FileLock::wait_for(entry(simulation_key(config())) / "lock");
  PruneOptions all;
  all.all = true;
  EXPECT_THAT(cache().prune(all), IsEmpty());
  EXPECT_THAT(cache().list(), SizeIs(1));
}

TEST_F(Cache, ALinkStandsForADataset) {
  const fs::path cached = cache().obtain(config(), "plane").folder;
  const fs::path link = folder_.path() / "data" / "walls";
  link_dataset(cached, link);
  EXPECT_EQ(fs::canonical(link), fs::canonical(cached));
  link_dataset(cached, link / "");
  EXPECT_TRUE(fs::exists(link / "dataset.yaml"));
  unlink_dataset(link);
  EXPECT_FALSE(fs::exists(fs::symlink_status(link)));
  EXPECT_TRUE(fs::exists(cached / "dataset.yaml"));
  folder_.write("mine/notes.txt", "mine\n");
  EXPECT_THAT(testing::error_of([&] {
                link_dataset(cached, folder_.path() / "mine");
                return 0;
              }),
              HasSubstr("holds other files"));
  const fs::path own = folder_.path() / "own";
  fs::create_directory_symlink(folder_.path() / "mine", own);
  unlink_dataset(own);
  EXPECT_TRUE(fs::is_symlink(own));
}

}  // namespace
}  // namespace saccade
