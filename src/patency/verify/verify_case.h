// SPDX-License-Identifier: Apache-2.0
// What a verification case is: a deck with runs (cases/verify/NAME.yaml), what is measured in each run, the figures made
// of the measurements, and the pictures. docs/VERIFICATION.md is made of them.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "patency/stages/scene.h"
#include "patency/verify/figures.h"
#include "patency/verify/run_data.h"
#include "patency/verify/svg.h"

namespace patency {

/// What a measure needs beside the scene.
struct RunContext {
    std::string name;                          ///< of the run, as in the deck
    std::filesystem::path reference;           ///< folder of stored results of other programs; need not exist
    std::function<void(const Scene&)> watch;   ///< to be called now and then: progress, and a way out by throwing
};

/// The runs that were done, by name.
class Results {
public:
    Results(std::map<std::string, RunData> runs, std::filesystem::path reference)
        : runs_(std::move(runs)), reference_(std::move(reference)) {}
    bool has(const std::string& run) const { return runs_.contains(run) && runs_.at(run).failure.empty(); }
    /// @throws Error with the reason if the run failed or was not done.
    const RunData& operator[](const std::string& run) const;
    bool was_tried(const std::string& run) const { return runs_.contains(run); }
    const std::filesystem::path& reference() const { return reference_; }

private:
    std::map<std::string, RunData> runs_;
    std::filesystem::path reference_;
};

/// Collects figures. One whose runs belong to another level is left out; one whose run failed has no value.
class FigureList {
public:
    explicit FigureList(const Results& results) : results_(results) {}
    struct Head {
        std::string key, unit;
        std::optional<Bar> bar;
    };
    /// value() is called only if all of `runs` were tried.
    void add(const Head& head, const std::vector<std::string>& runs, const std::function<double()>& value);
    std::vector<Figure> take() { return std::move(figures_); }

private:
    const Results& results_;
    std::vector<Figure> figures_;
};

struct VerifyCase {
    std::string name;
    std::string title;                                                  ///< one line for the report
    Level level = Level::quick;                                         ///< full: all of it runs at level full only
    std::function<bool(const std::string&)> is_full;                    ///< which runs are; empty: none
    std::function<void(Scene&, const RunContext&, RunData&)> measure;   ///< of moving particles
    /// Of a flow on cells instead, which it makes and solves itself; interrupted tells the solver to stop. Neither: no deck.
    std::function<void(const deck::Case&, const std::string& run, const std::filesystem::path& reference,
                       const std::function<bool()>& interrupted, RunData&)>
        measure_cells = {};
    /// Of solids, which it builds and steps itself.
    std::function<void(const deck::Case&, const std::string& run, const std::function<bool()>& interrupted, RunData&)>
        measure_solids = {};
    std::function<void(const Results&, FigureList&)> figures;
    std::function<std::vector<Picture>(const Results&)> pictures;   ///< may be empty
};

/// All cases, in the order of the report.
std::span<const VerifyCase> verification_cases();

// The groups of cases, one file each.
std::vector<VerifyCase> plane_cases();         // poiseuille, poiseuille_pressure, channel, taylor_green
std::vector<VerifyCase> pipe_cases();          // pipe, womersley, cells_womersley
std::vector<VerifyCase> windkessel_cases();    // windkessel, cells_windkessel
std::vector<VerifyCase> operator_cases();      // lattice_operators
std::vector<VerifyCase> nozzle_cases();        // fda_nozzle
std::vector<VerifyCase> coronary_cases();      // coronary_bifurcation
std::vector<VerifyCase> cell_cases();          // cells_pipe
std::vector<VerifyCase> cell_shape_cases();    // cells_poiseuille, cells_taper, cells_corner
std::vector<VerifyCase> vessel_cell_cases();   // cells_bifurcation, cells_left_coronary_tree
std::vector<VerifyCase> solid_point_cases();   // material_points, patch
std::vector<VerifyCase> solid_cases();         // beam, thick_tube, plastic_tube, taylor_bar
std::vector<VerifyCase> contact_cases();       // incline, two_rings, three_rings
std::vector<VerifyCase> stent_cases();         // plastic_ring, stent_ring, stent_free

}   // namespace patency
