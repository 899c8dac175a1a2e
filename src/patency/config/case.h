// SPDX-License-Identifier: Apache-2.0
// A case as typed numbers: what a deck says, in SI, defaults filled in. No reading or checking here:
// schema.cpp says what each key means, deck.h reads and writes. A member's default is the key's default.
// All of config/ is in namespace patency::deck: deck::Opening is what the deck says about an opening, and other
// folders have openings of their own.
#pragma once

#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "patency/base/vec.h"
#include "patency/config/deployment_deck.h"
#include "patency/config/solid_deck.h"

namespace patency::deck {

/// A part of the deck that is kept as it stands for a later stage: YAML on one line; empty if absent.
struct Kept {
    std::string yaml;
    bool operator==(const Kept&) const = default;
};

// Every choice of words in a deck is an enum whose words(...) stand in the order of its enumerators.
using Words = std::vector<std::string_view>;

enum class Mode { steady, periodic };
inline Words words(Mode) { return {"steady", "periodic"}; }

enum class ShapeType { channel, step, box, tube, cone, nozzle, branches };
inline Words words(ShapeType) { return {"channel", "step", "box", "tube", "cone", "nozzle", "branches"}; }

enum class BloodLaw { newtonian, carreau_yasuda, casson, power_law };
inline Words words(BloodLaw) { return {"newtonian", "carreau_yasuda", "casson", "power_law"}; }

enum class OpeningType { velocity, flow, pressure, resistance, rcr, coronary };
inline Words words(OpeningType) { return {"velocity", "flow", "pressure", "resistance", "rcr", "coronary"}; }

enum class VelocityProfile { plug, parabola, womersley, table, developed_startup };
inline Words words(VelocityProfile) { return {"plug", "parabola", "womersley", "table", "developed_startup"}; }

enum class BedState { hyperaemic, resting };
inline Words words(BedState) { return {"hyperaemic", "resting"}; }

enum class InitialVelocity { rest, plug, parabola, taylor_green, womersley, estimate, cells };
inline Words words(InitialVelocity) {
    return {"rest", "plug", "parabola", "taylor_green", "womersley", "estimate", "cells"};
}

enum class InitialPressure { zero, linear, estimate, cells };
inline Words words(InitialPressure) { return {"zero", "linear", "estimate", "cells"}; }

enum class SchemeName { sph, paper, cells };
inline Words words(SchemeName) { return {"sph", "paper", "cells"}; }

enum class Precision { mixed, double_ };   // "double" is a word of C++
inline Words words(Precision) { return {"mixed", "double"}; }

/// What a steady flow on cells gives whose jet has no rest: means over its last iterations, marked, or means over time.
enum class WithoutRest { means, follow };
inline std::vector<std::string_view> words(WithoutRest) { return {"means", "follow"}; }

enum class PressureReference { moving, fixed };
inline Words words(PressureReference) { return {"moving", "fixed"}; }

enum class StentLayout { rings, helix };
inline Words words(StentLayout) { return {"rings", "helix"}; }

enum class CrownFacing { aligned, staggered };
inline Words words(CrownFacing) { return {"aligned", "staggered"}; }

enum class ConnectorShape { straight, flex };
inline Words words(ConnectorShape) { return {"straight", "flex"}; }

/// The deck's word for a choice.
template <class E>
std::string_view word_of(E value) {
    return words(value)[std::size_t(value)];
}

struct About {   // `case`
    std::string name;
    Mode mode = Mode::steady;
    std::optional<double> period;   ///< s; there in mode periodic
    bool operator==(const About&) const = default;
};

struct NozzleSection {
    double z = 0;          ///< m, along the axis from the start
    double diameter = 0;   ///< m
    bool operator==(const NozzleSection&) const = default;
};

struct Branch {
    std::string name;
    Vec3 from, to;                   ///< m
    std::vector<double> diameters;   ///< m: at `from` and at `to`
    bool operator==(const Branch&) const = default;
};

/// A shape by its measures. Members that do not belong to the type stay at their defaults.
struct Shape {
    ShapeType type = ShapeType::channel;
    double gap = 0;                                      ///< channel, step: m between the plates (y = 0 and y = gap)
    double length = 0;                                   ///< channel, step (along x), tube, cone: m
    double step_height = 0;                              ///< step: m by which the lower plate lies higher at first
    double step_at = 0;                                  ///< step: m along x to where it drops
    Vec3 size;                                           ///< box: m
    std::array<bool, 3> periodic{false, false, false};   ///< box
    bool planar = false;                                 ///< box: two-dimensional, z = 0
    double diameter = 0;                                 ///< tube: m
    std::vector<double> diameters;                       ///< cone: m, at the start and at the end
    std::vector<NozzleSection> sections;                 ///< nozzle
    std::vector<Branch> branches;                        ///< branches
    Vec3 axis{1, 0, 0};                                  ///< tube, cone, nozzle: direction, any length
    Vec3 start;                                          ///< tube, cone, nozzle: m, the axis' first point
    bool operator==(const Shape&) const = default;

    bool is_planar() const {
        return type == ShapeType::channel || type == ShapeType::step || (type == ShapeType::box && planar);
    }
};

struct Extensions {
    double diameters = 0;   ///< of each opening: the length of a straight piece put on it
    bool operator==(const Extensions&) const = default;
};

/// A narrowing of a branch of the network with the profile of a cosine.
struct Lesion {
    std::string branch;
    double position = 0;   ///< m along the branch from its first point, or its opening there, to the middle
    double length = 0;     ///< m
    double diameter_stenosis_percent = 0;   ///< of the healthy diameter, at the middle
    double eccentricity = 0;    ///< 0: all around; 1: the lumen touches the healthy wall opposite to the plaque
    std::optional<Vec3> side;   ///< direction from the axis to the plaque
    bool operator==(const Lesion&) const = default;
};

struct Geometry {   // exactly one of surface, network, shape
    std::optional<std::filesystem::path> surface, network;
    std::optional<Shape> shape;
    std::optional<std::string> unit;    ///< of the file's coordinates: m, cm, mm or um
    std::optional<std::string> space;   ///< axes of the file's coordinates: LPS or RAS
    std::optional<int> label;           ///< surface: of a label map with several, which one is the vessel
    std::optional<std::string>
        inlet;   ///< surface: the opening that is the inlet, by name or number; absent: the largest
    std::map<std::string, std::string>
        names;   ///< surface: own names for openings, by the names that they are found under
    std::map<std::string, double>
        cut_back;   ///< surface: how far before its end [m] an opening is cut square to the centreline, by its name
    std::map<std::string, Vec3> branches;   ///< surface: names for branches, by a point within each [m]
    std::optional<Lesion> lesion;
    Extensions extensions;
    bool operator==(const Geometry&) const = default;
};

struct Blood {
    double density = 0;   ///< kg/m^3
    BloodLaw law = BloodLaw::newtonian;
    double viscosity = 0;                             ///< newtonian: Pa s
    double mu_0 = 0, mu_inf = 0;                      ///< carreau_yasuda: Pa s at rest and at infinite shear
    double lambda = 0;                                ///< carreau_yasuda: s
    double n = 0;                                     ///< carreau_yasuda, power_law: exponent
    double a = 0;                                     ///< carreau_yasuda: Yasuda's exponent (2: Carreau)
    double yield_stress = 0, plastic_viscosity = 0;   ///< casson: Pa, Pa s
    double consistency = 0;                           ///< power_law: Pa s^n
    double min_viscosity = 0;                         ///< power_law: Pa s
    double max_viscosity = 0;                         ///< power_law, casson: Pa s
    bool operator==(const Blood&) const = default;
};

/// mean + sum_k cosines[k] cos(2 pi (k+1) t / period) + sines[k] sin(2 pi (k+1) t / period)
struct Fourier {
    double mean = 0;                      ///< in the unit of the waveform
    double period = 0;                    ///< s
    std::vector<double> cosines, sines;   ///< equally many
    bool operator==(const Fourier&) const = default;
};

/// A velocity [m/s], flow [m^3/s] or pressure [Pa] over time, as its opening's type says.
struct Waveform {                                // exactly one of file, times + values, fourier
    std::optional<std::filesystem::path> file;   ///< CSV, columns time and value named with units
    std::vector<double> times;                   ///< s, increasing
    std::vector<double> values;
    std::optional<Fourier> fourier;
    std::optional<double> period;   ///< s; absent: the case's period
    bool operator==(const Waveform&) const = default;
};

/// A velocity profile over the relative radius: velocity over mean velocity.
struct ProfileTable {
    std::vector<double> radii;    ///< 0 (axis) to 1 (wall), increasing
    std::vector<double> speeds;   ///< relative; scaled to the opening's mean
    bool operator==(const ProfileTable&) const = default;
};

struct Opening {
    OpeningType type = OpeningType::pressure;
    VelocityProfile profile = VelocityProfile::plug;   ///< velocity, flow
    std::optional<ProfileTable> profile_table;         ///< profile table
    std::optional<double> velocity, peak_velocity;     ///< velocity: m/s into the domain; mean or largest
    std::optional<double> flow;                        ///< flow: m^3/s (planar m^2/s) into the domain
    std::optional<double> pressure;                    ///< pressure: Pa
    std::optional<Waveform> waveform;                  ///< velocity (mean), flow, pressure: instead of the constant
    double ramp = 0;                                   ///< velocity, flow, pressure: s, smooth rise from zero
    std::optional<double> resistance;                  ///< resistance: Pa s/m^3; absent: tuned to the bed
    double proximal_resistance = 0;                    ///< rcr, coronary: Pa s/m^3
    double distal_resistance = 0;                      ///< rcr, coronary: Pa s/m^3; 0: all is tuned to the bed
    double compliance = 0;                             ///< rcr; coronary, of its arteries: m^3/Pa
    double microvascular_resistance = 0;               ///< coronary: Pa s/m^3
    double myocardial_compliance = 0;                  ///< coronary: m^3/Pa of the vessels within the heart's muscle
    std::optional<Waveform> myocardial_pressure;       ///< coronary: Pa; of the muscle on these
    double distal_pressure = 0;                        ///< resistance, rcr, coronary: Pa
    std::optional<double> initial_pressure;            ///< rcr, coronary: Pa in the compliance at t = 0
    bool operator==(const Opening&) const = default;

    /// Its numbers are left to the bed behind it.
    bool is_tuned() const {
        if (type == OpeningType::resistance) return !resistance;
        return (type == OpeningType::rcr || type == OpeningType::coronary) && distal_resistance == 0;
    }
    /// Its pressure is left to the aorta.
    bool has_aortic_pressure() const { return type == OpeningType::pressure && !pressure && !waveform; }
    /// The muscle that squeezes it is left to the aorta's pulse.
    bool has_muscle_of_aorta() const { return type == OpeningType::coronary && !myocardial_pressure; }
};

struct Aorta {
    std::optional<double> pressure;   ///< Pa, mean
    double pulse = 5332.8954966;      ///< Pa, largest less least, of a periodic flow: 40 mmHg
    bool operator==(const Aorta&) const = default;
};

/// The small vessels behind the outlets, which tell what blood they take: outlets without numbers are tuned to it.
struct Bed {
    BedState state = BedState::hyperaemic;
    std::optional<double> flow;   ///< m^3/s of all such outlets together; absent: by the state and the inlet's area
    double murray_exponent = 3;   ///< an outlet takes its diameter to this power
    double venous_pressure = 5 * 133.322387415;   ///< Pa behind the bed
    bool operator==(const Bed&) const = default;
};

/// A stent by its measures (patency/shape/stent_pattern.h says what they are); diameters are outer ones.
struct StentPattern {
    StentLayout layout = StentLayout::rings;
    int rings = 0, crowns = 0;
    double length = 0;                                                 ///< m
    double diameter = 0, crimped_diameter = 0, nominal_diameter = 0;   ///< m
    double strut_width = 0, strut_thickness = 0;                       ///< m
    double crown_radius = 0, gap = 0;                                  ///< m
    int connectors = 1, connector_shift = 0;
    ConnectorShape connector_shape = ConnectorShape::straight;
    CrownFacing facing = CrownFacing::aligned;
    std::optional<double> connector_width;   ///< m; absent: the struts'
    double connector_swing = 0;              ///< m
    double edge_radius = 5e-6;               ///< m
    bool operator==(const StentPattern&) const = default;
};

/// Where the stent's middle lies: at an arc length of a branch, or by translation and rotation.
struct StentPlacement {                  // exactly one of arc_length, translation
    std::optional<std::string> branch;   ///< absent: the only one
    std::optional<double> arc_length;    ///< m from the branch's start
    std::optional<Vec3> translation;     ///< m
    Vec3 direction{1, 0, 0};             ///< translation: of the stent's axis, any length
    double rotation = 0;                 ///< rad, around the axis
    bool operator==(const StentPlacement&) const = default;
};

struct Stent {                           // exactly one of design, pattern, surface
    std::optional<std::string> design;   ///< a name of the library
    std::optional<double> length;        ///< m, of a design; absent: the library's
    std::optional<StentPattern> pattern;
    std::optional<std::filesystem::path> surface;   ///< closed, of the metal
    std::optional<std::string> unit;                ///< of the surface's coordinates
    std::optional<std::string> alloy;               ///< absent: the design's
    std::optional<StentPlacement> placement;        ///< absent: the middle of the worst lesion
    std::optional<double> spacing;                  ///< m between its particles; absent: a quarter of a strut
    std::optional<SolidMaterialChoice> material;    ///< absent: the alloy's of the table
    bool operator==(const Stent&) const = default;
};

struct Initial {
    std::optional<InitialVelocity> velocity;   ///< absent: Case::initial_velocity() chooses
    std::optional<double> speed;               ///< m/s: mean (plug, parabola) or amplitude (taylor_green)
    std::optional<InitialPressure> pressure;   ///< absent: Case::initial_pressure() chooses
    bool operator==(const Initial&) const = default;
};

/// A run that ends when its flow has settled, `duration` at the latest.
struct Convergence {
    double tolerance_percent = 0.5;   ///< change of flows and pressures at the openings from one window to the next
    std::optional<double> window;     ///< s; absent: an eighth of what the blood needs to pass the lumen, or the period
    bool operator==(const Convergence&) const = default;
};

struct Numerics {
    std::optional<SchemeName> scheme;   ///< absent: Case::scheme() chooses
    double spacing = 0;                 ///< m between particles; 0: follows the vessel (`across`)
    std::optional<double> across;       ///< of cells: spacings in the local diameter, instead of one spacing
    std::optional<double> smallest_spacing, largest_spacing;   ///< of cells [m]
    double smoothing_ratio = 1.3;                              ///< h over spacing
    std::optional<double> sound_speed;                         ///< m/s; absent: chosen (THEORY.md)
    std::optional<double> sound_speed_factor;   ///< sound speed over reference speed, instead of sound_speed
    std::optional<double> reference_speed;      ///< m/s, the largest expected; absent: from the openings
    Precision precision = Precision::mixed;
    double duration = 0;                             ///< s of simulated time
    std::optional<Convergence> convergence;          ///< absent: all of the duration is run
    WithoutRest without_rest = WithoutRest::means;   ///< of a steady flow on cells
    int steps_per_period = 200;                      ///< of a periodic flow on cells
    double advection_cfl = 0.25;                     // Zhang et al. 2020, dual-criteria stepping
    double acoustic_cfl = 0.6;                       // the same
    int threads = 0;                                 ///< 0: all
    PressureReference pressure_reference = PressureReference::moving;
    int seed = 1;
    SolidSettings solid;
    bool follows_vessel() const { return across.has_value(); }
    bool operator==(const Numerics&) const = default;
};

struct Probe {
    std::string name;
    Vec3 point;   ///< m
    bool operator==(const Probe&) const = default;
};

struct LineProfile {
    std::string name;
    Vec3 from, to;   ///< m
    int points = 51;
    std::vector<double> times;   ///< s; empty: at the end
    bool operator==(const LineProfile&) const = default;
};

struct Output {
    std::optional<double> interval;   ///< s between frames; absent: the last state only
    std::vector<std::string> fields{"velocity", "pressure"};
    std::vector<Probe> probes;
    std::vector<LineProfile> profiles;
    std::optional<double> average_from;          ///< s; means are taken from then to the end
    std::optional<double> checkpoint_interval;   ///< s of simulated time; absent: at the end of stages
    bool operator==(const Output&) const = default;
};

/// A variant of the deck: keys as in "numerics.spacing" and what they are in this run.
struct Run {
    std::string name;
    std::map<std::string, Kept> set;
    bool operator==(const Run&) const = default;
};

struct Case {
    int version = 1;
    About about;
    Geometry geometry;
    Blood blood;
    Wall wall;
    Vec3 body_force;   ///< m/s^2, of blood or solids
    std::map<std::string, Opening> openings;
    Aorta aorta;
    Bed bed;
    std::optional<Stent> stent;
    Deployment deployment;
    std::vector<SolidDeck> solids;   ///< with them there is no geometry and no blood
    std::vector<ContactDeck> contacts;
    Initial initial;
    Numerics numerics;
    Output output;
    std::vector<Run> runs;
    bool operator==(const Case&) const = default;

    /// A surface or a network, which has centrelines and an estimate; shapes have not.
    bool has_vessel() const { return geometry.surface || geometry.network; }
    /// The deck's word; else cells where a steady or periodic flow passes between walls at rest in a vessel.
    SchemeName scheme() const;
    /// Whether walls, forces and openings are such that the flow can be solved on cells.
    bool fits_cells() const;
    /// The deck's word; else that of moving particles in a vessel from the steady flow on cells, or from the estimate; of shapes rest.
    InitialVelocity initial_velocity() const;
    InitialPressure initial_pressure() const;
};

}   // namespace patency::deck
