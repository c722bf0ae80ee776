#include "tests/fuzz/core/core_targets.h"

#include <iterator>

namespace saccade::fuzz {

const std::vector<Target>& targets() {
  static const std::vector<Target> all = [] {
    std::vector<Target> list;
    for (auto part : {text_targets(), event_targets(), binary_targets(), folder_targets()})
      list.insert(list.end(), part.begin(), part.end());
    return list;
  }();
  return all;
}

}  // namespace saccade::fuzz
