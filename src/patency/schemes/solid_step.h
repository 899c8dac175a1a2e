// SPDX-License-Identifier: Apache-2.0
// One step of several solids with what acts on them. Each computes its stress as often as it must; what touches meets at
// the step of the fastest.                                                                  THEORY (20.11), (20.15)
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
    double mass_scaling = 1;   ///< that its density was multiplied by, for the record
    int stride = 1;            ///< steps of the fastest part for which one of its stresses is held: a power of three
    double drag = 0;           ///< of dynamic relaxation, held as long [1/s]
};

struct SolidSystem {
    std::vector<std::unique_ptr<SolidPart>> parts;
    std::vector<std::unique_ptr<Contact>> contacts;   ///< between surfaces of the parts
    Vec3 gravity;                                     ///< [m/s^2]
    bool is_relaxed = false;   ///< motion is damped away, each part at its own present frequency    THEORY (20.13)
};

/// The longest step that all parts bear now [s].
double stable_step(const SolidSystem& system);

/// Each part's stride: the largest that it bears beside the fastest part. Returns their largest, which a step consists of, times
/// the stable step [s].                                                                              THEORY (20.15)
double choose_strides(SolidSystem& system);
/// The largest stride.
int strides_in_step(const SolidSystem& system);

/// From `time` to time + dt [s], in as many steps of the fastest part as the largest stride. Throws DivergedError.
void solid_step(SolidSystem& system, double time, double dt);

/// Steps of a stent's ramp for less than 5 % of kinetic over internal energy after its first tenth: a ring of crowns opened from
/// 2.0 to 3.3 mm in these has 4.7 %, and the share falls as 1 over their square.                    THEORY (20.17)
inline constexpr double least_steps_of_ramp = 45000;

}   // namespace patency
