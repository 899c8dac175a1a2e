// SPDX-License-Identifier: Apache-2.0
// An open end of the domain: blood passes its plane in either direction. Beyond the plane stands a buffer of particles,
// some spacings long, in which velocity or pressure is imposed. A buffer particle that enters the domain leaves a copy of
// itself at the far end of the buffer; one that reaches the far end is removed.                     THEORY.md (8)
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "patency/bodies/fluid.h"
#include "patency/physics/open_ends/sound_absorber.h"

namespace patency {

/// The velocity at a place of a section [m/s]; many threads may ask.
using SectionVelocity = std::function<Vec3(const Vec3& x)>;

/// A plane section of a vessel. `mean_square` is that of the distance from the centre over the section [m^2].
struct SectionShape {
    Vec3 centre, normal;
    double area, mean_square;
};

struct OpenEnd {
    enum class Kind { velocity, pressure };

    std::string name;
    Kind kind = Kind::pressure;
    Vec3 centre, normal;        ///< of the plane; the normal points out of the domain
    double area = 0;            ///< of the section [m^2]; the gap [m] in the plane
    double mean_square = 0;     ///< of the distance from the centre, over the section [m^2]
    double reach = 0;           ///< particles farther than this from the axis belong to another branch [m]
    double buffer_length = 0;   ///< [m]
    bool undisturbed = false;   ///< keep every velocity along the axis in the buffer

    /// Velocity end: what is imposed over the section at time t.
    std::function<SectionVelocity(double t)> velocity;
    /// And the flow that this carries out of the domain [m^3/s]; if empty, the particles' is taken for it.
    std::function<double(double t)> imposed_flow;
    /// The vessel's section `entrance_depth` spacings before the plane, with the end's normal. Between the two, where an imposed
    /// velocity meets the wall's, blood is balanced by itself; without it, with the whole domain.          THEORY.md (4.10)
    std::optional<SectionShape> entrance_section{};
    SoundAbsorber absorber{};   ///< what it lets out is added to an imposed flow, in the imposed velocity's profile
    /// Pressure end: what is imposed at the plane, above the reference pressure [Pa].
    double pressure = 0;
    /// How much more is wanted per flow out of the domain [Pa s/m^3]: the response of an outlet model over the step.
    double resistance = 0;

    /// At the plane in the last acoustic step: flow out of the domain, imposed or measured [m^3/s], mean pressure there
    /// [Pa], and its slope along the normal [Pa/m].
    double flow = 0, mean_pressure = 0, slope = 0;
    double flow_excess =
        0;   ///< what the particles at the plane make of the flow beyond those inside, in the mean [m^3/s]
    /// Audit: particles and volume that have crossed the plane outwards less inwards since the start.
    std::int64_t crossed = 0;
    double crossed_volume = 0;

    /// What of the imposed velocity holds at time t: more or less of it than one while sound goes out.
    double share(double t) const { return absorber.let_out == 0 ? 1 : 1 + absorber.let_out / imposed_flow(t); }
    /// Distance beyond the plane [m].
    double axial(const Vec3& x) const { return dot(x - centre, normal); }
    bool in_reach(const Vec3& x) const {
        const Vec3 d = x - centre;
        const double s = dot(d, normal);
        return dot(d, d) - s * s < reach * reach;
    }

    /// Found anew in every advection step: indices of particles in the buffer, and of those near the plane.
    struct Member {
        std::uint32_t index;
        double s;        ///< beyond the plane [m]
        double weight;   ///< for averages over the section
    };
    std::vector<Member> buffer, inside, section;
    std::vector<Member> entrance,
        further;                  ///< particles between plane and entrance_section; and those around that section
    double entrance_excess = 0;   ///< of the divergences in the entrance [1/s]
    double section_depth = 0;     ///< how far before the plane the middle of `inside` lies [m]
};

/// How far before an end its entrance goes, and what is told of the flow there [spacings]: a corner of imposed and resting blood is in
/// the sums of two layers of supports.
inline constexpr double entrance_depth = 6, near_end = 8;

/// Sorts the particles near every end into its lists.
void find_members(const FluidParticles& fluid, double spacing, std::span<OpenEnd> ends);

/// Straight line through the pressure of the particles just inside: mean and slope at a velocity end; the slope through
/// the imposed value at a pressure end. pressure(i) gives that of particle i [Pa].
/// The value that an outlet model wants depends on the flow, and the flow answers to the value within the step, by the
/// acoustic admittance of the section: both are solved for together, or a stiff model would ring.    THEORY.md (8.8)
/// `impedance` is rho c of the blood [Pa s/m].
void fit_pressure(OpenEnd& end, double impedance, const std::function<double(std::uint32_t)>& pressure);

/// The flow through the plane at time t: what is imposed, or else from the particles around it. Their mean alone is that of
/// where they stand: 1 % too large in a pipe at D/12. A fitted parabola turns it into that over the section. THEORY.md (8.9)
/// An outlet model must see the flow at the plane at once, but half of the particles there are the buffer's, a few per
/// thousand off; what they differ in the mean from those just inside is taken off: `share` is how much of it is learnt now.
///                                                                                              THEORY.md (8.10)
void measure_flow(OpenEnd& end, const FluidParticles& fluid, double t, double share);

/// Area [m^2] times the mean velocity [m/s] through a section, from particles that stand anywhere in it: their weighted mean, and a
/// fitted parabola for where they stand.                                                         THEORY.md (8.9)
double flow_of_section(const SectionShape& section, const FluidParticles& fluid,
                       std::span<const OpenEnd::Member> members);

/// Lets particles cross planes, copies those that enter, removes those at the far ends, and renews the tails: copies of
/// a buffer's first particles (up to `tail` [m] beyond the plane) behind its last ones. New particles are ordered by
/// end, then those that enter before those of the tail, each by parent.
void exchange_particles(FluidParticles& fluid, double spacing, double tail, std::span<OpenEnd> ends);

}   // namespace patency
