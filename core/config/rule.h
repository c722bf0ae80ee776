#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "core/config/node.h"

namespace saccade::config {

class Fields;

/// What a described key must satisfy; returned by Fields, rules are chained behind it. Each rule
/// holds for every number of a list as well. A broken rule throws InputError with the location of
/// the value; a key that the file leaves out keeps its default, which is not checked again.
class Rule {
 public:
  static constexpr std::size_t kAnyLength = std::numeric_limits<std::size_t>::max();

  Rule& range(double low, double high);  ///< low <= x <= high
  Rule& above(double low);               ///< x > low
  Rule& at_least(double low);            ///< x >= low
  Rule& below(double high);              ///< x < high
  Rule& at_most(double high);            ///< x <= high

  Rule& length(std::size_t least, std::size_t most);       ///< of a list
  Rule& item_length(std::size_t least, std::size_t most);  ///< of every list in a list of lists

  Rule& one_of(const std::vector<std::string>& names);  ///< text, or every text of a list
  Rule& required();                                     ///< the file must state the key
  Rule& must_exist();  ///< a path; of "archive.zip!/inside.obj" the archive must exist

 private:
  friend class Fields;
  Rule(Fields& fields, std::string key, const Node* node)
      : fields_(fields), key_(std::move(key)), node_(node) {}

  template <class Holds>
  void check_numbers(Holds holds, const std::string& broken, const std::string& allowed) const;
  template <class Check>
  void check_texts(Check check) const;
  void check_length(const Node& list, const std::string& name, std::size_t least,
                    std::size_t most) const;
  Rule& note(const std::string& text);

  Fields& fields_;
  std::string key_;  ///< dotted, from the root
  const Node*
      node_;  ///< the value as stated (reading) or as it is (checking); nullptr: nothing to check
};

}  // namespace saccade::config
