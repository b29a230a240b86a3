#pragma once

#include "rimod/feature_set_t.hpp"
#include "rimod/object_model_t.hpp"
#include "rimod/range_image_t.hpp"
#include "rimod/scan_t.hpp"
#include "rimod/shard_candidates_t.hpp"

namespace rimod {

// True when all fields that sections of one whole have in common are equal to the last bit: all but
// the section's number and its lists.
bool SameHeader(const scan_t& a, const scan_t& b);
bool SameHeader(const range_image_t& a, const range_image_t& b);
bool SameHeader(const feature_set_t& a, const feature_set_t& b);
bool SameHeader(const object_model_t& a, const object_model_t& b);
bool SameHeader(const shard_candidates_t& a, const shard_candidates_t& b);

// A section with these common fields and empty lists.
scan_t HeaderOf(const scan_t& section);
range_image_t HeaderOf(const range_image_t& section);
feature_set_t HeaderOf(const feature_set_t& section);
object_model_t HeaderOf(const object_model_t& section);
shard_candidates_t HeaderOf(const shard_candidates_t& section);

}  // namespace rimod
