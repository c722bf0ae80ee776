#include "core/io/run/method_class.h"

#include <algorithm>
#include <array>
#include <vector>

namespace saccade {
namespace {

struct InputName {
  MethodInput input;
  const char* key;
  const char* text;
};

constexpr std::array<InputName, 7> kInputs{{{MethodInput::kEvents, "events", "events"},
                                            {MethodInput::kFrames, "frames", "frames"},
                                            {MethodInput::kImu, "imu", "IMU"},
                                            {MethodInput::kStart, "start", "given start"},
                                            {MethodInput::kMap, "map", "map"},
                                            {MethodInput::kPoses, "poses", "true poses"},
                                            {MethodInput::kDepth, "depth", "true depth"}}};

}  // namespace

void describe(config::Fields& fields, MethodClass& method) {
  std::vector<std::string> stated, known;
  for (const InputName& name : kInputs) {
    known.emplace_back(name.key);
    if (method.inputs.contains(name.input)) stated.emplace_back(name.key);
  }
  fields
      .value("inputs", stated,
             "What the method is given: `events`, `frames`, samples of the inertial sensor "
             "(`imu`), true poses of the first moments (`start`), a true picture of the scene with "
             "its depth (`map`), true poses at all times (`poses`), true depth at all times "
             "(`depth`).")
      .one_of(known)
      .required()
      .length(1, config::Rule::kAnyLength);
  fields.choice("processing", method.processing,
                {{"causal", Processing::kCausal},
                 {"fixed_lag", Processing::kFixedLag},
                 {"batch", Processing::kBatch}},
                "How far it looks ahead: a result depends on no measurement after its time but for "
                "the milliseconds of its own frame (`causal`), depends on or is revised by those "
                "of a limited time after it (`fixed_lag`), or depends on all (`batch`).");
  if (!fields.reading()) return;
  method.inputs.clear();
  for (const InputName& name : kInputs)
    if (std::find(stated.begin(), stated.end(), name.key) != stated.end())
      method.inputs.insert(name.input);
}

MethodClass merged(const MethodClass& a, const MethodClass& b) {
  MethodClass both = a;
  both.inputs.insert(b.inputs.begin(), b.inputs.end());
  both.processing = std::max(a.processing, b.processing);
  return both;
}

std::string inputs_text(const MethodClass& method) {
  std::string text;
  for (const InputName& name : kInputs)
    if (method.inputs.contains(name.input))
      text += (text.empty() ? "" : " + ") + std::string(name.text);
  return text;
}

std::string processing_text(const MethodClass& method) {
  switch (method.processing) {
    case Processing::kCausal:
      return "causal";
    case Processing::kFixedLag:
      return "fixed lag";
    case Processing::kBatch:
      break;
  }
  return "batch";
}

}  // namespace saccade
