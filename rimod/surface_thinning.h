#pragma once

#include "rimod/object_model.h"

namespace rimod {

// The model's surface with the first point of each cell of the spacing (m, > 0) and each side of
// the surface (normals more than 60 degrees apart are two sides). Name and box are the model's; it
// has no views.
ObjectModel ThinSurface(const ObjectModel& model, double spacing);

}  // namespace rimod
