#pragma once

#include "thimble/render/surface/spring_damper.h"
#include "thimble/render/touch.h"
#include "track/mesh_contact.h"

namespace thimble::render {

/// Is the force law of one rigid mesh with a springy, damped surface [BP 2, 3.1].
using MeshTouch = Touch<MeshContact, SpringDamper>;

}  // namespace thimble::render
