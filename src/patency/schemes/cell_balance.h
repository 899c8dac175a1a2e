// SPDX-License-Identifier: Apache-2.0
// A steady flow on cells: what its fields lack to the balance of volume and momentum in every cell, and the matrix that
// says how the balance answers to the fields. Solves for nothing (cell_solver.h).                 THEORY.md section 18
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <span>
#include <vector>

#include "patency/cells/cell_gradients.h"
#include "patency/cells/cell_mesh.h"
#include "patency/physics/fluid/rheology.h"
#include "patency/schemes/cell_matrix.h"
#include "patency/schemes/cell_terms.h"

namespace patency {

/// What holds at an opening. Flows are out of the domain [m^3/s], of a planar lumen per metre of depth [m^2/s].
struct CellEnd {
    enum class Kind {
        velocity,   ///< a velocity over the section, scaled so that the cells carry `flow`
        pressure,   ///< the mean pressure is pressure + resistance times flow
        flow,       ///< an even pressure, such that `flow` passes
    };
    Kind kind = Kind::pressure;
    /// [m/s]; of the other ends: what enters through them, scaled to the flow that does. Empty: a plug.
    std::function<Vec3(const Vec3& x)> velocity = {};
    /// Added to it where it is imposed, less what it carries [m/s]: a profile that changes with the flow. Empty: nothing.
    std::function<Vec3(const Vec3& x)> rest = {};
    double flow = 0;
    double pressure = 0, resistance = 0;   ///< [Pa], [Pa s/m^3]
};

struct CellFluid {
    double density;   ///< [kg/m^3]
    Rheology rheology;
    bool free_slip = false;
};

struct CellFields {
    std::vector<double> pressure;   ///< [Pa]
    std::vector<Vec3> velocity;     ///< [m/s]
};

/// What residuals are compared with: all that flows through, and the forces on walls and openings [1 of the balance's units].
struct CellScales {
    double flow = 0, force = 0;
};

/// What passes an opening.
struct CellEndState {
    double flow, pressure;   ///< out of the domain [m^3/s]; mean over the section [Pa]
};

/// How far the pseudo-time step goes.
struct PseudoStep {
    double courant;                ///< in cells that a signal crosses
    double pressure_share = 0.1;   ///< of the pressure's own term: with less of it a step is nearer to Newton's
};

class CellBalance {
public:
    /// The mesh must stay. Throws DeckError if no end tells the level of the pressure, or one's profile carries nothing.
    CellBalance(const CellMesh& mesh, const CellFluid& fluid, std::span<const CellEnd> ends, double reference_speed);

    /// What holds at the openings from now on; of the same kinds, and above the same level of the pressure.
    void set_ends(std::span<const CellEnd> ends);
    /// The flow changes: du/dt = rate u + rest at the instant that is sought [1/s], [m/s^2]. A rate of zero is a steady flow.  THEORY.md (18.16)
    void set_time_derivative(double rate, std::span<const Vec3> rest);
    /// Residuals count by these at least: a pulse passes through nothing.
    void set_least_scales(const CellScales& scales) { least_scales_ = scales; }
    const CellScales& scales() const { return scales_; }

    void set_fields(const CellFields& fields);
    CellFields fields() const;
    void set_transport(const cell_terms::Transport& transport) {
        transport_ = transport;
    }   ///< sharp, if nothing is said

    /// Gradients, viscosities, sound speeds and fluxes of the fields that stand, and what they lack. THEORY.md (18.3)
    void compute_residual(double kappa);
    /// Sum over the cells of |volume| and |momentum|, over the flow and over the forces at the walls and openings.
    double volume_residual() const { return volume_residual_; }
    double momentum_residual() const { return momentum_residual_; }
    /// Per cell: the larger of both for it alone.
    double lack(std::size_t cell) const {
        return std::max(std::abs(lack_[cell].volume) / scales_.flow, norm(lack_[cell].momentum) / scales_.force);
    }

    /// The matrix of a step and minus the residual.
    void fill(const PseudoStep& step, CellMatrix& matrix, CellVectors& right) const;
    /// Adds to y = matrix x what the openings' pressures answer.                                   THEORY.md (18.14)
    void add_openings(const CellVectors& x, CellVectors& y) const;
    void apply(const CellVectors& change);
    /// What the ends' pressures are guessed to have risen by [Pa].
    void raise_end_pressures(std::span<const double> rise);
    /// Ends of a pressure through which blood has begun to enter get the profile of what enters, and the other way round.
    void turn_ends();

    std::vector<CellEndState> end_states() const;
    /// What the next residual depends on beside the fields, for checkpoints: three numbers of every end.
    std::vector<double> end_memory() const;
    void restore_end_memory(std::span<const double> memory);
    /// Starts with the ends' pressures, ways and answering flows of the same ends on another mesh.
    void start_ends_as(const CellBalance& other);
    /// Per patch, zero away from walls [Pa].                                                       THEORY.md (18.7)
    std::vector<Vec3> wall_shear_stress() const;
    std::vector<double> patch_pressure() const;   ///< per patch: what its cell extrapolates to it [Pa]
    std::span<const Mat3> velocity_gradient() const { return grad_u_; }   ///< over the reference speed [1/m]
    std::span<const Vec3> pressure_gradient() const { return grad_p_; }   ///< over density and its square [1/m]
    /// The fields of another mesh, from the gradients here.
    CellFields fields_at(std::span<const Vec3> places) const;

private:
    struct End {
        CellEnd::Kind kind;
        std::vector<std::uint32_t> patches;
        cell_terms::OpenResponse response{};
        bool enters = false;   // through an end of a pressure: then with the end's profile
        double wanted = 0;     // flow
        double flow = 0, pressure = 0, conductance = 0;
        double slope = 0;   // of the pressure by the free flow

        bool is_imposed() const { return kind == CellEnd::Kind::velocity || enters; }
    };
    void set_end(const CellEnd& said, End& end);
    double free_change(const End& end, const CellVectors& x) const;   // of its free flow, by a change of the fields
    void make_all_gradients();
    void compute_gradients();
    void compute_cell_states(double kappa);
    void compute_open_pressures();
    void compute_patch_fluxes();
    void sum_fluxes();
    cell_terms::Face face_of(const CellFace& face) const;
    double wall_viscosity(const cell_terms::CellState& cell, const CellPatch& patch) const;
    bool is_open(const CellPatch& patch) const {
        return patch.opening >= 0 && !ends_[std::size_t(patch.opening)].is_imposed();
    }
    /// What an opening's flow is at a patch of it, with the end's profile; and the patch's share of the flow.
    Vec3 imposed(std::size_t k) const {
        return rest_[k] - ends_[std::size_t(mesh_.patches[k].opening)].flow * profile_[k];
    }
    Mat3 imposed_gradient(std::size_t k) const {
        return rest_gradient_[k] - ends_[std::size_t(mesh_.patches[k].opening)].flow * profile_gradient_[k];
    }
    double share_of(std::size_t k) const { return -dot(profile_[k], mesh_.patches[k].area); }
    Vec3 way_to(const CellPatch& patch) const { return patch.centroid - mesh_.point[patch.cell]; }

    // Inside, velocities are over the reference speed U, pressures over density U^2, viscosities over U.
    const CellMesh& mesh_;
    CellFluid fluid_;
    double speed_, level_ = 0;   // level: subtracted from all pressures [Pa]
    bool is_newtonian_;
    cell_terms::Transport transport_ = cell_terms::sharp;
    CellGradients for_pressure_, for_velocity_;
    std::vector<double> width_;   // of a cell [m]
    std::vector<Vec3> profile_;   // per patch: the velocity of a flow of -1 through its end
    std::vector<Mat3> profile_gradient_;
    std::vector<Vec3> rest_;   // per patch: what is imposed beside that, and carries nothing
    std::vector<Mat3> rest_gradient_;
    std::vector<End> ends_;
    double rate_ = 0;               // of the time derivative [1/m]
    std::vector<Vec3> rate_rest_;   // [1/m]
    CellScales least_scales_, scales_;

    std::vector<cell_terms::CellState> state_;
    std::vector<Vec3> grad_p_;
    std::vector<Mat3> grad_u_;
    std::vector<double> p_;
    std::vector<Vec3> u_;
    std::vector<cell_terms::Flux> face_flux_, patch_flux_, lack_;
    double volume_residual_ = 0, momentum_residual_ = 0;
};

}   // namespace patency
