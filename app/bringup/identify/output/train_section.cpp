#include "bringup/identify/output/train_section.h"

#include <fmt/format.h>

namespace thimble::bringup {

TrainKey TrainKey::of(const std::string& name, const std::string& unit,
                      const std::array<Estimate, 3>& values, const IdentifiedMark& mark) {
  return {
      .name = name,
      .value = fmt::format("[{:.5g}, {:.5g}, {:.5g}]", values[0].value, values[1].value,
                           values[2].value),
      .remark = fmt::format("{} [I {}, {}, +- {:.2g}, {:.2g}, {:.2g}]", unit, mark.date, mark.arm,
                            values[0].plus_minus, values[1].plus_minus, values[2].plus_minus)};
}

bool put_train_keys(const YAML::Node& simulation, const std::vector<TrainKey>& keys,
                    FileLines& lines) {
  if (keys.empty()) return true;
  const YAML::Node train = simulation["drive_train"];
  if (train && train.Style() == YAML::EmitterStyle::Flow) {
    // On one line: the comments of all its values at the end.
    YAML::Node changed = YAML::Clone(train);
    std::string remarks;
    for (const TrainKey& key : keys) {
      changed[key.name] = YAML::Load(key.value);
      remarks += fmt::format("{}{}: {}", remarks.empty() ? "" : "; ", key.name, key.remark);
    }
    changed.SetStyle(YAML::EmitterStyle::Flow);
    return lines.exchange(train, YAML::Dump(changed) + "  # " + remarks);
  }
  std::vector<std::string> section;
  for (const TrainKey& key : keys) {
    const std::string text = key.value + "  # " + key.remark;
    if (!train || !train[key.name]) {
      section.push_back(key.name + ": " + text);
    } else if (!lines.exchange(train[key.name], text)) {
      return false;
    }
  }
  if (section.empty()) return true;
  if (train) return train.size() > 0 && lines.add_before(train.begin()->first, section);
  for (std::string& line : section) line = "  " + line;
  section.insert(section.begin(), "drive_train:");
  for (const auto& entry : simulation) {
    if (entry.first.as<std::string>() == "tip") return lines.add_before(entry.first, section);
  }
  return false;
}

}  // namespace thimble::bringup
