// Events in the layouts of other programs than DSEC's.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "core/io/events/event_formats.h"
#include "core/io/events/events_h5.h"
#include "tests/support/command.h"
#include "tests/support/error_of.h"
#include "tests/support/h5_content.h"
#include "tests/unit/core/io/events/random_events.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using testing::error_of;
using testing::H5Content;
using ::testing::HasSubstr;
using testing::kSensor;

/// Times in whole microseconds.
Events some_events(std::size_t count, TimeNs start_ns) {
  Events events = testing::random_events(count, start_ns, 5000);
  for (Event& event : events) event.t_ns -= event.t_ns % 1000;
  sort_ties(events);
  return events;
}

struct Columns {
  std::vector<std::uint16_t> x, y;
  std::vector<std::uint8_t> p;
  std::vector<std::int8_t> signed_p;
  std::vector<std::int64_t> t;

  explicit Columns(const Events& events) {
    for (const Event& event : events) {
      x.push_back(event.x);
      y.push_back(event.y);
      p.push_back(event.polarity > 0 ? 1 : 0);
      signed_p.push_back(event.polarity);
      t.push_back(event.t_ns / 1000);
    }
  }
};

class H5Layouts : public ::testing::Test {
 protected:
  testing::TemporaryFolder folder_;
  fs::path file_ = folder_.path() / "e.h5";
  Events events_ = some_events(5000, 1'500'000'000'000'000'000);
};

TEST_F(H5Layouts, ColumnsAtTheRoot) {
  const Columns columns(events_);
  H5Content(file_)
      .column("/x", columns.x)
      .column("/y", columns.y)
      .column("/p", columns.p)
      .column("/t", columns.t);
  EXPECT_EQ(read_events(file_, kSensor), events_);
  const EventFileInfo info = read_event_file_info(file_);
  EXPECT_EQ(info.count, events_.size());
  EXPECT_EQ(info.last_ns, events_.back().t_ns);
  const TimeWindow window{events_[100].t_ns, events_[3000].t_ns};
  for (const Event& event : read_events(file_, kSensor, window)) {
    EXPECT_GE(event.t_ns, window.start_ns);
    EXPECT_LT(event.t_ns, window.end_ns);
  }
}

TEST_F(H5Layouts, M3edHasTwoCamerasWithTheirResolution) {
  const Columns left(events_);
  const Events others = some_events(100, 5'000'000);
  const Columns right(others);
  {
    H5Content content(file_);
    for (const auto& [side, columns] : {std::pair{"left", &left}, std::pair{"right", &right}}) {
      const std::string group = std::string("/prophesee/") + side;
      content.column(group + "/x", columns->x).column(group + "/y", columns->y);
      content.column(group + "/p", columns->signed_p).column(group + "/t", columns->t);
      content.column(group + "/calib/resolution", std::vector<std::int64_t>{240, 180});
    }
  }
  EXPECT_EQ(read_events(file_, {}), events_);
  EXPECT_EQ(read_events(file_.string() + "!/prophesee/right", {}), others);
  EXPECT_EQ(stated_sensor(file_).width, 240);
  EXPECT_THAT(error_of([&] { return read_events(file_.string() + "!/prophesee/up", {}); }),
              HasSubstr("e.h5:/prophesee/up: there is no such group"));
}

TEST_F(H5Layouts, MvsecHasAMatrixWithSeconds) {
  std::vector<double> rows;
  for (const Event& event : events_)
    for (const double value :
         {static_cast<double>(event.x), static_cast<double>(event.y),
          1e-9 * static_cast<double>(event.t_ns), static_cast<double>(event.polarity)})
      rows.push_back(value);
  H5Content(file_).array<double>("/davis/left/events", {events_.size(), 4}, rows);
  EXPECT_EQ(read_events(file_, kSensor), events_);
  EXPECT_EQ(read_events(file_.string() + "!/davis/left", kSensor), events_);
  rows[4 * 7 + 2] = 0;
  H5Content(file_).array<double>("/davis/left/events", {events_.size(), 4}, rows);
  EXPECT_THAT(error_of([&] { return read_events(file_, kSensor); }),
              HasSubstr("e.h5:/davis/left/events.t[7]: time goes back"));
  H5Content(file_).array<double>("/davis/left/events", {events_.size(), 3}, rows);
  EXPECT_THAT(error_of([&] { return read_events(file_, kSensor); }),
              HasSubstr("a matrix of rows x y t p"));
}

/// A row as Prophesee's programs store it.
struct Row {
  std::uint16_t x, y;
  std::int16_t p;
  std::int64_t t;
};

void write_prophesee(const fs::path& file, const std::vector<Row>& rows, H5Z_filter_t filter = 0) {
  H5Content content(file);
  const hid_t type = H5Tcreate(H5T_COMPOUND, sizeof(Row));
  H5Tinsert(type, "x", HOFFSET(Row, x), H5T_NATIVE_UINT16);
  H5Tinsert(type, "y", HOFFSET(Row, y), H5T_NATIVE_UINT16);
  H5Tinsert(type, "p", HOFFSET(Row, p), H5T_NATIVE_INT16);
  H5Tinsert(type, "t", HOFFSET(Row, t), H5T_NATIVE_INT64);
  const hsize_t size = rows.size();
  const hid_t space = H5Screate_simple(1, &size, nullptr);
  const hid_t links = H5Pcreate(H5P_LINK_CREATE);
  H5Pset_create_intermediate_group(links, 1);
  const hid_t layout = H5Pcreate(H5P_DATASET_CREATE);
  if (filter != 0) {
    H5Pset_chunk(layout, 1, &size);
    // Optional: HDF5 leaves it out where it is not installed, and says so in the mask of the chunk.
    H5Pset_filter(layout, filter, H5Z_FLAG_OPTIONAL, 0, nullptr);
  }
  const hid_t set = H5Dcreate2(content.id(), "/CD/events", type, space, links, layout, H5P_DEFAULT);
  if (filter == 0) {
    EXPECT_GE(H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, rows.data()), 0);
  } else {
    const hsize_t begin = 0;
    EXPECT_GE(H5Dwrite_chunk(set, H5P_DEFAULT, 0, &begin, 4, "ECF!"), 0);
  }
  const hid_t text = H5Tcopy(H5T_C_S1);
  H5Tset_size(text, 8);
  const hid_t one = H5Screate(H5S_SCALAR);
  const hid_t geometry = H5Acreate2(content.id(), "geometry", text, one, H5P_DEFAULT, H5P_DEFAULT);
  H5Awrite(geometry, text, "240x180");
  H5Aclose(geometry);
  H5Sclose(one);
  H5Tclose(text);
  H5Dclose(set);
  H5Pclose(layout);
  H5Pclose(links);
  H5Sclose(space);
  H5Tclose(type);
}

TEST_F(H5Layouts, ProphesseHasATable) {
  std::vector<Row> rows;
  for (const Event& event : events_)
    rows.push_back({event.x, event.y, static_cast<std::int16_t>(event.polarity > 0 ? 1 : 0),
                    event.t_ns / 1000});
  write_prophesee(file_, rows);
  EXPECT_EQ(read_events(file_, {}), events_);
  EXPECT_EQ(stated_sensor(file_).height, 180);
  rows[3].p = 2;
  write_prophesee(file_, rows);
  EXPECT_THAT(error_of([&] { return read_events(file_, {}); }),
              HasSubstr("/CD/events.p[3]: polarity 2 must be 1, 0 or -1"));
}

TEST_F(H5Layouts, AFilterThatIsMissingIsNamed) {
  constexpr H5Z_filter_t kEcf = 0x8ECF;
  if (H5Zfilter_avail(kEcf) > 0) GTEST_SKIP() << "the filter is installed";
  write_prophesee(file_, {{1, 2, 1, 5}}, kEcf);
  EXPECT_THAT(error_of([&] { return read_events(file_, {}); }),
              HasSubstr("Prophesee's ECF, which no Debian package has"));
}

TEST_F(H5Layouts, SaysWhereEventsAreLookedFor) {
  H5Content(file_).column("/other", std::vector<double>{1});
  EXPECT_THAT(error_of([&] { return read_events(file_, {}); }),
              HasSubstr("/events: the group is missing; events are looked for there and in "
                        "/CD/events, /prophesee/left, /davis/left/events, /"));
}

}  // namespace
}  // namespace saccade
