#include "eval/report/thesis.h"

#include <algorithm>
#include <array>
#include <cctype>

namespace saccade::thesis {
namespace {

constexpr std::array kSequences{Sequence{"walls", 1.8, 2.0, 6.8, 5.9},
                                Sequence{"planes", 0.9, 1.2, 2.2, 2.5},
                                Sequence{"office", 1.6, 1.0, 19, 7.7}};

constexpr std::array kTracking{
    Tracking{"walls", false, {1.3, 0.5, 2.5, 1.4}, {0.7, 0.2, 1.0, 0.7}, 477, 3.3, 633},
    Tracking{"planes", false, {2.2, 0.4, 3.0, 2.2}, {0.2, 0.1, 0.5, 0.2}, 317, 2.9, 463},
    Tracking{"office", false, {1.6, 1.2, 4.9, 2.0}, {1.1, 0.8, 3.4, 1.4}, 554, 2.8, 837},
    Tracking{"walls", true, {2.8, 1.6, 6.7, 3.2}, {1.4, 0.8, 3.8, 1.6}, 90, 20, 11427}};

bool same_name(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](unsigned char x, unsigned char y) {
    return std::tolower(x) == std::tolower(y);
  });
}

}  // namespace

const Sequence* find_sequence(std::string_view name) {
  for (const Sequence& sequence : kSequences)
    if (same_name(sequence.name, name)) return &sequence;
  return nullptr;
}

const Tracking* find_tracking(std::string_view sequence, bool fast) {
  for (const Tracking& tracking : kTracking)
    if (tracking.fast == fast && same_name(tracking.sequence, sequence)) return &tracking;
  return nullptr;
}

}  // namespace saccade::thesis
