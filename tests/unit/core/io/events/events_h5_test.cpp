#include "core/io/events/events_h5.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <hdf5.h>

#include <algorithm>
#include <fstream>
#include <functional>
#include <limits>
#include <vector>

#include "core/process/parallel.h"
#include "tests/support/command.h"
#include "tests/support/error_of.h"
#include "tests/unit/core/io/events/random_events.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using ::testing::ContainsRegex;
using testing::error_of;
using ::testing::HasSubstr;
using testing::kSensor;
using testing::random_events;
using testing::read_file;
using testing::TemporaryFolder;

constexpr auto kUs = TimestampUnit::kMicroseconds;
constexpr auto kNs = TimestampUnit::kNanoseconds;

void write(const fs::path& file, std::span<const Event> events, TimestampUnit unit,
           std::size_t piece = 100'000) {
  EventH5Writer writer(file, unit);
  for (std::size_t i = 0; i < events.size(); i += piece)
    writer.append(events.subspan(i, std::min(piece, events.size() - i)));
  writer.close();
}

Events sorted(Events events) {
  sort_ties(events);
  return events;
}

/// Events as a file in microseconds keeps them.
Events rounded_to_us(Events events) {
  for (Event& event : events) event.t_ns = (event.t_ns + 500) / 1000 * 1000;
  return sorted(events);
}

Events within(const Events& events, TimeWindow window) {
  Events result;
  for (const Event& event : events)
    if (event.t_ns >= window.start_ns && event.t_ns < window.end_ns) result.push_back(event);
  return result;
}

class EventsH5 : public ::testing::Test {
 protected:
  /// Writes a small valid file, lets `damage` change it through HDF5, and reads it.
  std::string error_after(const std::function<void(hid_t)>& damage, SensorSize size = kSensor) {
    write(file_, events_, kUs);
    const hid_t file = H5Fopen(file_.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
    damage(file);
    H5Fclose(file);
    ::testing::internal::CaptureStderr();
    const std::string error = error_of([&] { return EventH5Reader(file_).read(size); });
    EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
    return error;
  }

  TemporaryFolder folder_;
  const fs::path file_ = folder_.path() / "events.h5";
  const Events events_ = random_events(1000, 0, 5000);
};

/// Overwrites entry `index` of a dataset.
void set(hid_t file, const char* path, hsize_t index, std::int64_t value) {
  const hid_t dataset = H5Dopen2(file, path, H5P_DEFAULT);
  const hid_t space = H5Dget_space(dataset);
  const hsize_t one = 1;
  H5Sselect_hyperslab(space, H5S_SELECT_SET, &index, nullptr, &one, nullptr);
  const hid_t memory = H5Screate_simple(1, &one, nullptr);
  H5Dwrite(dataset, H5T_NATIVE_INT64, memory, space, H5P_DEFAULT, &value);
  H5Sclose(memory);
  H5Sclose(space);
  H5Dclose(dataset);
}

void resize(hid_t file, const char* path, hsize_t length) {
  const hid_t dataset = H5Dopen2(file, path, H5P_DEFAULT);
  H5Dset_extent(dataset, &length);
  H5Dclose(dataset);
}

void replace(hid_t file, const char* path, hid_t type, hsize_t length) {
  H5Ldelete(file, path, H5P_DEFAULT);
  const hid_t space = H5Screate_simple(1, &length, nullptr);
  H5Dclose(H5Dcreate2(file, path, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
  H5Sclose(space);
}

TEST_F(EventsH5, NanosecondsRoundTripExactly) {
  const Events events = random_events(300'000);
  write(file_, events, kNs);
  EXPECT_EQ(EventH5Reader(file_).read(kSensor), sorted(events));
}

TEST_F(EventsH5, MicrosecondsRoundToTheNearest) {
  const Events events = random_events(1'200'000, 0, 300);  // more than one batch of chunks
  write(file_, events, kUs);
  EXPECT_EQ(EventH5Reader(file_).read(kSensor), rounded_to_us(events));
}

TEST_F(EventsH5, TimesFarFromZeroKeepTheirValue) {
  for (const TimeNs start : {1'468'939'993'123'456'000L, -2'500'000'000L}) {
    const Events events = random_events(1000, start);
    write(file_, events, kNs);
    EXPECT_EQ(EventH5Reader(file_).read(kSensor), sorted(events));
    EXPECT_LT(fs::file_size(file_), 100'000U);  // the index of milliseconds stays short
  }
}

TEST_F(EventsH5, WindowsSelectExactlyTheirEvents) {
  const Events events = random_events(400'000, 3'000'000, 900);
  write(file_, events, kUs);
  const Events all = rounded_to_us(events);
  const EventH5Reader reader(file_);
  constexpr TimeNs kMin = std::numeric_limits<TimeNs>::min();
  constexpr TimeNs kMax = std::numeric_limits<TimeNs>::max();
  const TimeNs last = all.back().t_ns;
  for (const TimeWindow window : {TimeWindow{kMin, 100'000'000},
                                  {100'000'000, kMax},
                                  {50'000'000, 50'000'000},
                                  {17'000'000, 17'001'000},
                                  {17'123'456, 205'999'999},
                                  {kMin, 0},
                                  {0, 3'000'000},
                                  {last, kMax},
                                  {last + 1, kMax},
                                  {last - 1000, last},
                                  {kMax - 1, kMax},
                                  {-5, last + 1},
                                  {200, 100}})
    EXPECT_EQ(reader.read(kSensor, window), within(all, window))
        << window.start_ns << " " << window.end_ns;
}

TEST_F(EventsH5, EmptyStream) {
  write(file_, {}, kUs);
  EXPECT_TRUE(EventH5Reader(file_).read(kSensor).empty());
  EXPECT_EQ(EventH5Reader(file_).info().count, 0U);
}

TEST_F(EventsH5, InfoNeedsNoReading) {
  write(file_, events_, kNs);
  const EventFileInfo info = EventH5Reader(file_).info();
  EXPECT_EQ(info.count, events_.size());
  EXPECT_EQ(info.first_ns, events_.front().t_ns);
  EXPECT_EQ(info.last_ns, events_.back().t_ns);
  EXPECT_EQ(info.unit, kNs);
}

TEST_F(EventsH5, BytesDependOnTheEventsAlone) {
  const Events events = random_events(1'500'000);
  const int threads = thread_count();
  set_thread_count(1);
  write(file_, events, kUs);
  const std::string one = read_file(file_);
  set_thread_count(3);
  write(file_, events, kUs, 777'777);
  EXPECT_TRUE(read_file(file_) == one);
  set_thread_count(threads);
}

TEST_F(EventsH5, FollowsTheDsecLayout) {
  write(file_, events_, kUs);
  const hid_t file = H5Fopen(file_.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  ASSERT_GE(file, 0);
  const auto type_is = [&](const char* path, hid_t type) {
    const hid_t dataset = H5Dopen2(file, path, H5P_DEFAULT);
    const hid_t stored = H5Dget_type(dataset);
    EXPECT_GT(H5Tequal(stored, type), 0) << path;
    H5Tclose(stored);
    H5Dclose(dataset);
  };
  type_is("/events/x", H5T_STD_U16LE);
  type_is("/events/y", H5T_STD_U16LE);
  type_is("/events/p", H5T_STD_U8LE);
  type_is("/events/t", H5T_STD_I64LE);
  type_is("/ms_to_idx", H5T_STD_U64LE);
  type_is("/t_offset", H5T_STD_I64LE);
  const hid_t dataset = H5Dopen2(file, "/ms_to_idx", H5P_DEFAULT);
  const Events events = rounded_to_us(events_);
  std::vector<std::uint64_t> index(static_cast<std::size_t>(events.back().t_ns / 1'000'000 + 1));
  ASSERT_EQ(H5Dread(dataset, H5T_NATIVE_UINT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, index.data()), 0);
  for (std::size_t ms = 0; ms < index.size(); ++ms) {
    const TimeNs t = static_cast<TimeNs>(ms) * 1'000'000;
    EXPECT_GE(events[index[ms]].t_ns, t);
    EXPECT_TRUE(index[ms] == 0 || events[index[ms] - 1].t_ns < t);
  }
  H5Dclose(dataset);
  H5Fclose(file);
}

TEST_F(EventsH5, FilesWithoutUnitOrIndexAreDsecs) {
  write(file_, events_, kUs);
  const hid_t file = H5Fopen(file_.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  H5Adelete_by_name(file, "/events/t", "unit", H5P_DEFAULT);
  H5Ldelete(file, "/ms_to_idx", H5P_DEFAULT);
  H5Ldelete(file, "/t_offset", H5P_DEFAULT);
  H5Fclose(file);
  EXPECT_EQ(EventH5Reader(file_).read(kSensor), rounded_to_us(events_));
  const TimeWindow window{1'000'000, 2'000'000};
  EXPECT_EQ(EventH5Reader(file_).read(kSensor, window), within(rounded_to_us(events_), window));
}

TEST_F(EventsH5, OffsetIsAddedToTheTimes) {
  write(file_, events_, kUs);
  const hid_t file = H5Fopen(file_.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  const hid_t dataset = H5Dopen2(file, "/t_offset", H5P_DEFAULT);
  const std::int64_t offset = 7;
  H5Dwrite(dataset, H5T_NATIVE_INT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, &offset);
  H5Dclose(dataset);
  H5Fclose(file);
  EXPECT_EQ(EventH5Reader(file_).info().first_ns, rounded_to_us(events_).front().t_ns + 7000);
}

TEST_F(EventsH5, NamesThePlaceOfWhatIsWrong) {
  EXPECT_THAT(error_after([](hid_t f) { set(f, "/events/t", 500, 0); }),
              HasSubstr("events.h5:/events/t[500]: time goes back"));
  EXPECT_THAT(error_after([](hid_t f) { set(f, "/events/x", 20, 240); }),
              HasSubstr("events.h5:/events/x[20]: pixel (240, "));
  EXPECT_THAT(error_after([](hid_t f) { set(f, "/events/y", 21, 180); }),
              HasSubstr("events.h5:/events/y[21]: pixel"));
  EXPECT_THAT(error_after([](hid_t f) { set(f, "/events/p", 22, 2); }),
              HasSubstr("events.h5:/events/p[22]: polarity 2"));
  EXPECT_EQ(error_after([](hid_t f) { set(f, "/events/x", 20, 240); }, {}), "no error");
}

TEST_F(EventsH5, ChecksStructureAndTypes) {
  EXPECT_THAT(error_after([](hid_t f) { H5Ldelete(f, "/events", H5P_DEFAULT); }),
              HasSubstr("events.h5:/events: the group is missing"));
  EXPECT_THAT(error_after([](hid_t f) { H5Ldelete(f, "/events/p", H5P_DEFAULT); }),
              HasSubstr("events.h5:/events/p: the dataset is missing"));
  EXPECT_THAT(error_after([](hid_t f) { resize(f, "/events/y", 999); }),
              HasSubstr("events.h5:/events/y: has 999 entries, /events/x has 1000"));
  EXPECT_THAT(error_after([](hid_t f) { replace(f, "/events/t", H5T_NATIVE_DOUBLE, 1000); }),
              HasSubstr("events.h5:/events/t: must hold whole numbers"));
  EXPECT_THAT(error_after([](hid_t f) { replace(f, "/events/x", H5T_NATIVE_INT32, 1000); }),
              HasSubstr("events.h5:/events/x: must hold unsigned whole numbers of 16 bits"));
}

TEST_F(EventsH5, ChecksTheUnit) {
  const auto relabel = [](hid_t file) {
    H5Adelete_by_name(file, "/events/t", "unit", H5P_DEFAULT);
    const hid_t type = H5Tcopy(H5T_C_S1);
    H5Tset_size(type, 2);
    const hid_t space = H5Screate(H5S_SCALAR);
    const hid_t attribute = H5Acreate_by_name(file, "/events/t", "unit", type, space, H5P_DEFAULT,
                                              H5P_DEFAULT, H5P_DEFAULT);
    H5Awrite(attribute, type, "ms");
    H5Aclose(attribute);
    H5Sclose(space);
    H5Tclose(type);
  };
  EXPECT_THAT(error_after(relabel), HasSubstr("attribute \"unit\" is 'ms'"));
}

TEST_F(EventsH5, ChecksTheIndex) {
  EXPECT_THAT(error_after([](hid_t f) { set(f, "/ms_to_idx", 2, 5000); }),
              HasSubstr("events.h5:/ms_to_idx[2]: indices must not"));
  write(file_, events_, kUs);
  const hid_t file = H5Fopen(file_.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  const auto last_ms = static_cast<hsize_t>(events_.back().t_ns / 1'000'000);
  for (hsize_t ms = 1; ms <= last_ms; ++ms) set(file, "/ms_to_idx", ms, 999);
  H5Fclose(file);
  EXPECT_THAT(error_of([&] {
                return EventH5Reader(file_).read(kSensor, {2'000'000, 3'000'000});
              }),
              HasSubstr("events.h5:/ms_to_idx: contradicts"));
}

TEST_F(EventsH5, TruncatedAndForeignFiles) {
  write(file_, random_events(200'000), kUs);
  for (const double share : {0.9, 0.5, 0.01}) {
    const auto size = static_cast<double>(fs::file_size(file_));
    fs::resize_file(file_, static_cast<std::uintmax_t>(size * share));
    EXPECT_THAT(error_of([&] { return EventH5Reader(file_).read(kSensor); }),
                ContainsRegex("events.h5: is no HDF5 file, or is truncated or damaged "
                              "\\(HDF5: truncated file: eof = [0-9]+"));
  }
  std::ofstream(file_) << "";
  EXPECT_THAT(error_of([&] { return EventH5Reader(file_); }), HasSubstr("is no HDF5 file"));
  EXPECT_THAT(error_of([&] { return EventH5Reader(folder_.path() / "no.h5"); }),
              HasSubstr("no.h5: no such file"));
  EXPECT_THAT(error_of([&] { return EventH5Reader(folder_.path()); }), HasSubstr("is no HDF5"));
}

/// Replaces a column by one of another type, length of chunks and filters that holds the same.
void store_otherwise(hid_t file, const char* path, hid_t type, hsize_t chunk, bool with_deflate) {
  hid_t dataset = H5Dopen2(file, path, H5P_DEFAULT);
  hid_t space = H5Dget_space(dataset);
  const hsize_t count = static_cast<hsize_t>(H5Sget_simple_extent_npoints(space));
  std::vector<std::int64_t> values(count);
  H5Dread(dataset, H5T_NATIVE_INT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
  H5Dclose(dataset);
  H5Sclose(space);
  H5Ldelete(file, path, H5P_DEFAULT);
  space = H5Screate_simple(1, &count, nullptr);
  const hid_t layout = H5Pcreate(H5P_DATASET_CREATE);
  H5Pset_chunk(layout, 1, &chunk);
  if (with_deflate) H5Pset_deflate(layout, 6);
  dataset = H5Dcreate2(file, path, type, space, H5P_DEFAULT, layout, H5P_DEFAULT);
  H5Dwrite(dataset, H5T_NATIVE_INT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
  H5Dclose(dataset);
  H5Pclose(layout);
  H5Sclose(space);
}

TEST_F(EventsH5, ColumnsOfOtherTypesAndChunksHoldTheSame) {
  const Events events = rounded_to_us(random_events(700'000, 0, 300));
  const TimeWindow window{events[300'000].t_ns, events[650'000].t_ns};
  // Of the types of p and t, those that are unpacked here and one that is left to the library.
  for (const hid_t time :
       {H5T_STD_U32LE, H5T_STD_I64LE, H5T_STD_U64LE, H5T_STD_I32LE, H5T_STD_I64BE})
    for (const bool with_deflate : {false, true}) {
      write(file_, events, kUs);
      const hid_t file = H5Fopen(file_.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
      store_otherwise(file, "/events/t", time, 30'000, with_deflate);
      store_otherwise(file, "/events/x", H5T_STD_U16LE, 400'000, with_deflate);
      H5Fclose(file);
      EXPECT_EQ(read_events(file_, kSensor), events);
      EXPECT_EQ(read_events(file_, kSensor, window), within(events, window));
    }
}

TEST_F(EventsH5, AreReadTheSameByAnyNumberOfThreads) {
  const Events events = sorted(random_events(1'500'000, 0, 300));
  write(file_, events, kNs);
  for (const int threads : {1, 2, 5}) {
    set_thread_count(threads);
    EXPECT_EQ(read_events(file_, kSensor), events);
    EventStream stream(file_, kSensor);
    std::size_t given = 0;
    for (auto next = stream.next(); !next.empty(); next = stream.next()) {
      ASSERT_TRUE(std::equal(next.begin(), next.end(),
                             events.begin() + static_cast<std::ptrdiff_t>(given)));
      given += next.size();
    }
    EXPECT_EQ(given, events.size());
  }
  set_thread_count(0);
}

TEST_F(EventsH5, ATimeBeyondTheRangeIsAnErrorInAnyBlock) {
  const Events events = random_events(300'000, 0, 300);
  write(file_, events, kUs);
  const hid_t file = H5Fopen(file_.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  set(file, "/events/t", 299'999, std::numeric_limits<std::int64_t>::max() / 100);
  H5Fclose(file);
  EXPECT_THAT(error_of([&] { static_cast<void>(read_events(file_, kSensor)); }),
              HasSubstr("/events/t[299999]: the time is too large"));
}

TEST_F(EventsH5, DamagedChunkNamesTheDataset) {
  const Events events = random_events(200'000);
  write(file_, events, kUs);
  std::fstream stream(file_, std::ios::in | std::ios::out | std::ios::binary);
  stream.seekp(static_cast<std::streamoff>(fs::file_size(file_) / 2));
  stream << std::string(2000, '\x55');
  stream.close();
  EXPECT_THAT(error_of([&] { return EventH5Reader(file_).read(kSensor); }),
              HasSubstr("events.h5:/events/"));
}

TEST_F(EventsH5, WithoutCloseNothingIsWritten) {
  {
    EventH5Writer writer(file_, kUs);
    writer.append(events_);
  }
  EXPECT_TRUE(fs::is_empty(folder_.path()));
}

TEST_F(EventsH5, MayStateTheSensor) {
  for (const SensorSize size : {SensorSize{}, SensorSize{346, 260}}) {
    EventH5Writer writer(file_, kUs, size);
    writer.append(events_);
    writer.close();
    EXPECT_EQ(stated_sensor(file_).width, size.width);
  }
  const SensorSize sensor = stated_sensor(file_);
  EXPECT_EQ(sensor.width, 346);
  EXPECT_EQ(sensor.height, 260);
  EXPECT_EQ(stated_sensor(folder_.write("a.txt", "no event")).width, 0)
      << "text cannot, and is not read";
}

TEST_F(EventsH5, ASensorWithoutPixelsIsAnError) {
  EXPECT_THAT(error_after([](hid_t file) {
                const hid_t group = H5Gopen2(file, "events", H5P_DEFAULT);
                const hid_t space = H5Screate(H5S_SCALAR);
                const hid_t width =
                    H5Acreate2(group, "width", H5T_STD_I32LE, space, H5P_DEFAULT, H5P_DEFAULT);
                const int none = 0;
                H5Awrite(width, H5T_NATIVE_INT, &none);
                H5Aclose(width);
                H5Sclose(space);
                H5Gclose(group);
              }),
              HasSubstr("/events: attribute \"width\" must be a number of pixels"));
}

TEST_F(EventsH5, EndingChoosesTheFormat) {
  for (const char* name : {"a.h5", "a.hdf5", "a.txt", "a.csv"}) {
    const std::unique_ptr<EventWriter> writer = make_event_writer(folder_.path() / name, kNs);
    writer->append(events_);
    writer->close();
    EXPECT_EQ(read_events(folder_.path() / name, kSensor), sorted(events_)) << name;
    EXPECT_EQ(read_event_file_info(folder_.path() / name).count, events_.size());
  }
}

/// Puts an attribute with `count` entries of a type where a single one is expected.
void set_attribute(hid_t file, const char* object, const char* name, hid_t type, hsize_t count,
                   const void* values) {
  const hid_t place = H5Oopen(file, object, H5P_DEFAULT);
  if (H5Aexists(place, name) > 0) H5Adelete(place, name);
  const hid_t space = H5Screate_simple(1, &count, nullptr);
  const hid_t attribute = H5Acreate2(place, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
  H5Awrite(attribute, type, values);
  H5Aclose(attribute);
  H5Sclose(space);
  H5Oclose(place);
}

TEST_F(EventsH5, AttributesThatAreListsAreRefused) {
  const std::vector<int> numbers(1000, 240);
  EXPECT_THAT(error_after([&](hid_t file) {
                set_attribute(file, "/events", "width", H5T_NATIVE_INT, 1000, numbers.data());
              }),
              HasSubstr("attribute \"width\" must be a number"));
  const hid_t fixed = H5Tcopy(H5T_C_S1);
  H5Tset_size(fixed, 2);
  const std::string units(2000, 'u');
  EXPECT_THAT(error_after([&](hid_t file) {
                set_attribute(file, "/events/t", "unit", fixed, 1000, units.data());
              }),
              HasSubstr("attribute \"unit\" must be a single text"));
  const hid_t variable = H5Tcopy(H5T_C_S1);
  H5Tset_size(variable, H5T_VARIABLE);
  const std::vector<const char*> texts(1000, "us");
  EXPECT_THAT(error_after([&](hid_t file) {
                set_attribute(file, "/events/t", "unit", variable, 1000, texts.data());
              }),
              HasSubstr("attribute \"unit\" must be a single text"));
  H5Tclose(fixed);
  H5Tclose(variable);
}

TEST_F(EventsH5, ASizeThatTheFileCannotHoldTakesNoMemory) {
  constexpr hsize_t kHuge = hsize_t{1} << 40U;
  const std::string error = error_after([](hid_t file) {
    for (const char* column : {"/events/x", "/events/y", "/events/p", "/events/t"})
      resize(file, column, kHuge);
  });
  EXPECT_THAT(error, HasSubstr("events.h5:/events/t: claims"));
  EXPECT_THAT(error, HasSubstr("cannot hold so many"));
  EXPECT_THAT(error_after([](hid_t file) { resize(file, "/ms_to_idx", kHuge); }),
              HasSubstr("events.h5:/ms_to_idx: claims"));
}

TEST_F(EventsH5, AnIndexOfManyDimensionsIsRefused) {
  EXPECT_THAT(error_after([](hid_t file) {
                H5Ldelete(file, "/ms_to_idx", H5P_DEFAULT);
                const hsize_t sides[6] = {1, 1, 1, 1, 1, 1};
                const hid_t space = H5Screate_simple(6, sides, nullptr);
                H5Dclose(H5Dcreate2(file, "/ms_to_idx", H5T_STD_U64LE, space, H5P_DEFAULT,
                                    H5P_DEFAULT, H5P_DEFAULT));
                H5Sclose(space);
              }),
              HasSubstr("/ms_to_idx: must have one dimension"));
}

TEST_F(EventsH5, AGapOfADayIsRefusedBeforeItsIndexIsMade) {
  const Events events{{0, 1, 2, 1}, {86'400'000'000'000, 1, 2, 1}};
  EXPECT_THAT(error_of([&] {
                write(file_, events, kUs);
                return 0;
              }),
              HasSubstr("the events span more than 18 hours"));
  EXPECT_FALSE(fs::exists(file_));
}

}  // namespace
}  // namespace saccade
