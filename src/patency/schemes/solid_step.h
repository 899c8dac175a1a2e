// SPDX-License-Identifier: Apache-2.0
// One step of several solids with what acts on them: the same time for all.                         THEORY (20.11)
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "patency/bodies/contact.h"
#include "patency/bodies/solid_surface.h"
#include "patency/schemes/solid_body.h"

namespace patency {

/// A pressure on a face over time.
struct SolidPressure {
    std::uint16_t face = 0;
    std::function<double(double time)> pressure;   ///< [Pa]
};

/// A solid in the scene, with its surface.
struct SolidPart {
    std::string name;
    Solid solid;
    std::unique_ptr<SolidBody> body;
    std::unique_ptr<SolidSurface> surface;
    std::vector<SolidPressure> pressures;
};

struct SolidSystem {
    std::vector<std::unique_ptr<SolidPart>> parts;
    std::vector<std::unique_ptr<Contact>> contacts;   ///< between surfaces of the parts
    Vec3 gravity;              ///< [m/s^2]
    bool is_relaxed = false;   ///< motion is damped away, each part at its own present frequency    THEORY (20.13)
};

/// The longest step that all parts bear now [s].
double stable_step(const SolidSystem& system);

/// From `time` to time + dt [s]. Throws DivergedError.
void solid_step(SolidSystem& system, double time, double dt);

}   // namespace patency
