#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "rimod/object_model.h"
#include "rimod/object_model_t.hpp"

namespace rimod {

// The encoded size that no section of a model exceeds, bytes.
constexpr int kMaxModelSectionBytes = 180000;

// The model as sections for RIMOD_MODEL or a model file. Throws std::invalid_argument for an
// invalid model (ValidateModel). JoinModelSections gives the same model back, bit for bit.
std::vector<object_model_t> ToSections(const ObjectModel& model, std::int64_t utime);

struct JoinedModel {
  std::optional<ObjectModel> model;
  std::string error;  // the cause; empty when there is a model
};

// The model that the sections make, in any order; a section given twice counts once. Missing
// sections, sections of another model and contents that are not valid give an error.
JoinedModel JoinModelSections(const std::vector<object_model_t>& sections);

}  // namespace rimod
