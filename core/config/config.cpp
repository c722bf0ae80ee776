#include "core/config/config.h"

namespace saccade::config {

void Session::read(const Document& document, const std::function<void(Fields&)>& describe_root,
                   std::span<const FormerKey> former) {
  Fields root(Fields::Mode::kRead, {}, nullptr, document.root().location);
  root.former_keys_ = former;
  root.child({}, &document.root(), describe_root);
}

Node Session::write(const std::function<void(Fields&)>& describe_root) {
  return Fields(Fields::Mode::kPrint, {}, nullptr, {}).child({}, nullptr, describe_root);
}

void Session::check(const std::function<void(Fields&)>& describe_root) {
  Fields(Fields::Mode::kCheck, {}, nullptr, {}).child({}, nullptr, describe_root);
}

std::vector<ReferenceKey> Session::reference(const std::function<void(Fields&)>& describe_root) {
  return explore_keys([&](ReferenceRecord& record) {
    Fields root(Fields::Mode::kReference, {}, nullptr, {});
    root.reference_ = &record;
    root.child({}, nullptr, describe_root);
  });
}

}  // namespace saccade::config
