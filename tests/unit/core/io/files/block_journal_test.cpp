#include "core/io/files/block_journal.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <string_view>

#include "tests/support/command.h"
#include "tests/support/error_of.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using testing::error_of;
using ::testing::HasSubstr;

void append(BlockJournal& journal, std::string_view text) {
  journal.append(std::as_bytes(std::span(text)));
}

std::string content(const BlockJournal& journal) {
  std::string text;
  journal.read([&](std::span<const std::byte> bytes) {
    text.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  });
  return text;
}

class Journal : public ::testing::Test {
 protected:
  testing::TemporaryFolder folder_;
  const fs::path file_ = folder_.path() / "journal";
};

TEST_F(Journal, KeepsWhatWasFlushed) {
  std::uint64_t length = 0;
  {
    BlockJournal journal(file_, 0);
    append(journal, "one ");
    append(journal, "two ");
    journal.flush();
    append(journal, "three ");
    journal.flush();
    journal.flush();  // nothing new: no empty block
    length = journal.length();
    append(journal, "lost");
    EXPECT_EQ(content(journal), "one two three ");
  }
  BlockJournal journal(file_, length);
  EXPECT_EQ(content(journal), "one two three ");
  append(journal, "four");
  journal.flush();
  EXPECT_EQ(content(journal), "one two three four");
}

TEST_F(Journal, IsCutToTheLengthThatWasStated) {
  BlockJournal first(file_, 0);
  append(first, "one");
  first.flush();
  const std::uint64_t length = first.length();
  append(first, "two");
  first.flush();
  BlockJournal again(file_, length);
  EXPECT_EQ(content(again), "one");
  EXPECT_EQ(fs::file_size(file_), length);
}

TEST_F(Journal, LargeContentComesBackInBlocks) {
  BlockJournal journal(file_, 0);
  std::string text;
  for (int i = 0; i < 100'000; ++i) {
    const std::string word = std::to_string(i) + " ";
    append(journal, word);
    text += word;
  }
  journal.flush();
  EXPECT_EQ(content(journal), text);
}

TEST_F(Journal, TellsWhatIsDamaged) {
  std::uint64_t length = 0;
  {
    BlockJournal journal(file_, 0);
    append(journal, std::string(1000, 'a'));
    journal.flush();
    length = journal.length();
    append(journal, std::string(1000, 'b'));
    journal.flush();
  }
  std::fstream(file_, std::ios::in | std::ios::out).seekp(static_cast<std::streamoff>(length) + 500)
      << 'x';
  EXPECT_THAT(error_of([&] { return content(BlockJournal(file_, 2 * length)); }),
              HasSubstr("journal: is damaged at byte " + std::to_string(length)));
  EXPECT_THAT(error_of([&] { return BlockJournal(file_, 3 * length).length(); }),
              HasSubstr("is shorter than it was"));
}

TEST_F(Journal, IsFollowedWhileItGrows) {
  BlockJournalTail tail(file_);
  const auto fresh = [&] {
    std::string text;
    tail.read([&](std::span<const std::byte> bytes) {
      text.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    });
    return text;
  };
  EXPECT_EQ(fresh(), "") << "it is not there yet";
  {
    BlockJournal journal(file_, 0);
    append(journal, "one");
    EXPECT_EQ(fresh(), "") << "it is not flushed";
    journal.flush();
    EXPECT_EQ(fresh(), "one");
    EXPECT_EQ(fresh(), "");
    append(journal, "two");
    journal.flush();
    append(journal, "three");
    journal.flush();
    EXPECT_EQ(fresh(), "twothree");
  }
  // A block of which the end is still missing.
  const std::string whole = testing::read_file(file_);
  std::uint64_t length = whole.size();
  {
    BlockJournal journal(file_, length);
    append(journal, "four");
    journal.flush();
    length = journal.length();
  }
  fs::resize_file(file_, length - 1);
  EXPECT_EQ(fresh(), "");
  EXPECT_EQ(fs::file_size(file_), length - 1) << "a tail changes nothing";
  std::ofstream(file_, std::ios::app | std::ios::binary) << 'r';
  EXPECT_EQ(fresh(), "four");
  // One that began anew.
  BlockJournal journal(file_, 0);
  append(journal, "five");
  journal.flush();
  EXPECT_EQ(fresh(), "five");
}

}  // namespace
}  // namespace saccade
