#include "core/io/events/event_queue.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <optional>

#include "core/error.h"
#include "core/process/parallel.h"
#include "tests/support/command.h"
#include "tests/unit/core/io/events/random_events.h"

namespace saccade {
namespace {

using testing::kSensor;
using testing::TemporaryFolder;

class EventQueues : public ::testing::Test {
 protected:
  static constexpr std::size_t kCount = 2'500'000;  // several blocks of the file

  EventQueues() {
    sort_ties(events_);
    const auto writer = make_event_writer(file_, TimestampUnit::kNanoseconds);
    writer->append(events_);
    writer->close();
  }

  TemporaryFolder folder_;
  std::filesystem::path file_ = folder_.path() / "events.h5";
  Events events_ = testing::random_events(kCount, 0, 300);
};

TEST_F(EventQueues, GiveAllEventsHoweverManyAreSeenAhead) {
  for (const int threads : {1, 3}) {
    set_thread_count(threads);
    EventQueue queue(EventStream(file_, kSensor));
    std::size_t given = 0, longest = 0;
    for (std::size_t step = 1;; step = step * 3 % 400'009 + 1) {
      const auto ahead = queue.ahead(2 * step);
      longest = std::max(longest, ahead.size());
      if (ahead.empty()) break;
      ASSERT_TRUE(ahead.size() >= 2 * step || queue.is_complete());
      const std::size_t count = std::min(step, ahead.size());
      ASSERT_TRUE(std::equal(ahead.begin(), ahead.begin() + static_cast<std::ptrdiff_t>(count),
                             events_.begin() + static_cast<std::ptrdiff_t>(given)));
      queue.drop(count);
      given += count;
    }
    EXPECT_EQ(given, kCount);
    EXPECT_EQ(queue.dropped(), kCount);
    // Of a block that came when hardly enough was ahead.
    EXPECT_LT(longest, 2'000'000U) << "the memory is that of what is seen, not of the recording";
  }
  set_thread_count(0);
}

TEST_F(EventQueues, EndWithTheWindow) {
  const TimeNs start = events_[1'048'570].t_ns,
               end = events_[1'048'580].t_ns;  // over a block's border
  EventQueue queue(EventStream(file_, kSensor, {start, end}));
  const auto ahead = queue.ahead(1'000);
  EXPECT_TRUE(queue.is_complete());
  const auto in_window = std::count_if(events_.begin(), events_.end(), [&](const Event& event) {
    return event.t_ns >= start && event.t_ns < end;
  });
  EXPECT_EQ(static_cast<std::ptrdiff_t>(ahead.size()), in_window);
  EXPECT_EQ(ahead.front().t_ns, start);
}

TEST_F(EventQueues, TheFirstEventIsFoundWithoutTheOthers) {
  EXPECT_EQ(first_event_ns(file_), events_.front().t_ns);
  EXPECT_EQ(first_event_ns(folder_.write("events.txt", "0.5 1 1 1\n0.6 2 2 0\n")), 500'000'000);
  EXPECT_EQ(first_event_ns(folder_.write("none.txt", "# t x y p\n")), std::nullopt);
}

TEST_F(EventQueues, AnErrorComesWithItsBlock) {
  std::string text;
  for (int i = 0; i < 200'000; ++i) text += "1.000000000 1 1 1\n";
  for (int i = 0; i < 200'000; ++i) text += "2.000000000 1 1 1\n";
  EventStream stream(folder_.write("events.txt", text + "3.0 1 1 7\n"), kSensor);
  EXPECT_EQ(stream.next().size(), 200'000U);
  EXPECT_THROW(static_cast<void>(stream.next()), InputError);
}

}  // namespace
}  // namespace saccade
