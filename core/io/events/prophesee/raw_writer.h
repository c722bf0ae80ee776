#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

#include "core/io/events/event_file.h"
#include "core/io/events/prophesee/raw_header.h"
#include "core/io/events/rounded_events.h"
#include "core/io/files/atomic_file.h"

namespace saccade {

/// What the writers of Prophesee's encodings have in common: the header, times in us from an
/// origin, and coordinates that have 11 bits.
class RawEventWriter : public EventWriter {
 public:
  RawEventWriter(const std::filesystem::path& file, RawEncoding encoding, SensorSize sensor);
  void append(std::span<const Event> events) final;
  void close() final;
  [[nodiscard]] std::uint64_t count() const final { return written_ + events_.size(); }

 protected:
  /// Appends the words of events of one time, `t_us` from the origin, to the data.
  virtual void encode(std::int64_t t_us, std::span<const Event> events) = 0;

  template <class Word>
  void put(Word word) {
    data_.append(reinterpret_cast<const char*>(&word), sizeof word);
  }

 private:
  void write_complete();
  void write_block();
  void write_header(TimeNs first_ns);
  void check(const Event& event) const;
  void flush();

  AtomicFile target_;
  std::ofstream stream_;
  RawEncoding encoding_;
  SensorSize sensor_;
  RoundedEvents events_{TimestampUnit::kMicroseconds};
  std::int64_t origin_us_ = 0;
  bool has_header_ = false;
  std::string data_;
  std::uint64_t written_ = 0;
};

}  // namespace saccade
