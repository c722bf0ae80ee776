#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <filesystem>
#include <functional>

#include "core/io/dataset/dataset_writer.h"
#include "core/io/events/event_file.h"
#include "core/io/files/atomic_file.h"
#include "core/io/files/block_journal.h"
#include "core/io/files/resumable_folder.h"
#include "core/io/images/exr_file.h"
#include "core/io/images/image_file.h"
#include "core/io/ply_file.h"
#include "core/random.h"
#include "tests/support/command.h"
#include "tests/support/error_of.h"
#include "tests/unit/core/io/events/random_events.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

/// While it lives, no file of this process may grow beyond `bytes`: what a full disk looks like.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }

 private:
  rlimit before_{};
  void (*handler_)(int);
};

/// Runs `write` on a file of a new folder with almost no space and expects an error that names the
/// file, and nothing left behind.
void expect_clean_failure(const std::string& name,
                          const std::function<void(const fs::path&)>& write) {
  const testing::TemporaryFolder folder;
  std::string error;
  {
    const FileSizeLimit limit(3000);
    error = testing::error_of([&] { return write(folder.path() / name), 0; });
  }
  EXPECT_THAT(error, HasSubstr("cannot be written"));
  EXPECT_TRUE(fs::is_empty(folder.path())) << *fs::directory_iterator(folder.path());
}

ImageF noise() {
  ImageF image(64, 64);
  for (std::size_t i = 0; i < image.size(); ++i)
    image.pixels()[i] = static_cast<float>(Random(1).uniform(0, i));
  return image;
}

TEST(FullDisk, EveryWriterFailsCleanly) {
  expect_clean_failure("f.txt",
                       [](const fs::path& f) { write_atomically(f, std::string(10'000, 'x')); });
  expect_clean_failure("f.exr", [](const fs::path& f) { write_exr(f, noise(), "Y"); });
  expect_clean_failure("f.png", [](const fs::path& f) {
    ImageU8 image(64, 64);
    for (std::size_t i = 0; i < image.size(); ++i)
      image.pixels()[i] = static_cast<std::uint8_t>(Random(1).below(256, 0, i));
    write_png(f, image);
  });
  expect_clean_failure("f.ply", [](const fs::path& f) {
    PointCloud cloud;
    cloud.positions.resize(1000, Eigen::Vector3f::Zero());
    write_ply(f, cloud);
  });
}

TEST(FullDisk, EventWritersFailCleanly) {
  for (const char* name : {"events.txt", "events.h5"})
    expect_clean_failure(name, [](const fs::path& f) {
      const std::unique_ptr<EventWriter> writer =
          make_event_writer(f, TimestampUnit::kMicroseconds);
      writer->append(testing::random_events(2'000'000));
      writer->close();
    });
}

TEST(FullDisk, DatasetFailsCleanly) {
  expect_clean_failure("dataset", [](const fs::path& f) {
    const ResumableFolder folder(f, "dataset.yaml", {});
    DatasetWriter writer(folder.path(), {64, 64, 100, 100, 32, 32, {}});
    writer.write_events(testing::random_events(100'000));
    writer.finish({});
  });
}

TEST(FullDisk, JournalFailsCleanly) {
  expect_clean_failure("dataset", [](const fs::path& f) {
    const ResumableFolder folder(f, "dataset.yaml", {});
    BlockJournal journal(folder.journal() / "events", 0);
    journal.append(std::vector<std::byte>(10'000));
    journal.flush();
  });
}

TEST(FullDisk, ErrorSaysWhatToDo) {
  const testing::TemporaryFolder folder;
  const FileSizeLimit limit(100);
  EXPECT_THAT(testing::error_of([&] {
                return write_atomically(folder.path() / "f", std::string(10'000, 'x')), 0;
              }),
              HasSubstr("make room there or write to another place"));
}

}  // namespace
}  // namespace saccade

#if defined(__SANITIZE_ADDRESS__)
/// HDF5 itself loses a buffer when a file cannot be written to its end, which several such tests in
/// one process show. It is asked by the sanitizer, for the whole program.
extern "C" const char* __lsan_default_suppressions() { return "leak:libhdf5"; }
#endif
