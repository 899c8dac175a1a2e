// SPDX-License-Identifier: Apache-2.0
// The outlet models against results that other programs stored: SimVascular's 0-D solver (svZeroDSolver, c7b0ca09) and
// its 3-D solver (svFSI-Tests 04-fluid/01-pipe3D_RCR, c38514ff). All in cgs units, as stored: the laws are linear and
// do not know. Skipped where the data are absent.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>
#include <vector>

#include "patency/physics/open_ends/outlets.h"

namespace patency {
namespace {

const std::filesystem::path reference = std::filesystem::path(PATENCY_SOURCE_DIR) / "../shared/data/reference";

std::vector<double> column(const nlohmann::json& result, const char* name) {   // {"0": v, "1": v, ..}
    std::vector<double> values;
    for (std::size_t i = 0; i < result.at(name).size(); ++i) values.push_back(result.at(name).at(std::to_string(i)));
    return values;
}

struct ZeroD {
    nlohmann::json outlet, vessel;
    std::vector<double> time, flow, inlet_pressure, outlet_pressure;
};

ZeroD read_zero_d(const std::string& name) {
    const auto read = [](const std::filesystem::path& path) { return nlohmann::json::parse(std::ifstream(path)); };
    const auto deck = read(reference / "svZeroD" / (name + ".json"));
    const auto result = read(reference / "svZeroD" / ("result_" + name + ".json"));
    return {deck.at("boundary_conditions").at(1).at("bc_values"),
            deck.at("vessels").at(0).at("zero_d_element_values"),
            column(result, "time"),
            column(result, "flow_out"),
            column(result, "pressure_in"),
            column(result, "pressure_out")};
}

/// Rows of numbers, after `skip` lines.
std::vector<std::vector<double>> read_rows(const std::filesystem::path& path, int skip, int columns) {
    std::ifstream file(path);
    std::string line;
    for (int i = 0; i < skip; ++i) std::getline(file, line);
    std::vector<std::vector<double>> rows;
    for (double x; file >> x;) {
        if (rows.empty() || int(rows.back().size()) == columns) rows.emplace_back();
        rows.back().push_back(x);
    }
    return rows;
}

class AgainstSvZeroD : public testing::Test {
    void SetUp() override {
        if (!exists(reference / "svZeroD")) GTEST_SKIP() << "the reference data are not beside this checkout";
    }
};
class AgainstSvFsi : public testing::Test {
    void SetUp() override {
        if (!exists(reference / "svFSI_pipe_RCR")) GTEST_SKIP() << "the reference data are not beside this checkout";
    }
};

OutletModel make_rcr(const nlohmann::json& o) { return Rcr{o.at("Rp"), o.at("C"), o.at("Rd"), o.at("Pd")}; }

TEST_F(AgainstSvZeroD, steady_outlets) {
    // Stored to the solver's tolerance of 1e-9 relative.
    const ZeroD a = read_zero_d("steadyFlow_R_RCR");
    const OutletModel rcr = make_rcr(a.outlet);
    EXPECT_NEAR(outlet_pressure(rcr, make_steady_state(rcr, 5), 5), a.outlet_pressure.back(), 1e-5);

    const ZeroD b = read_zero_d("steadyFlow_R_coronary");
    const auto& o = b.outlet;
    const OutletModel coronary = Coronary{
        o.at("Ra1"), o.at("Ca"), o.at("Ra2"), o.at("Cc"), o.at("Rv1"), o.at("P_v"), make_constant(o.at("Pim").at(0))};
    OutletState x{};   // from empty: the stored run is 30 s long, ours the same in 30 steps
    for (int i = 0; i < 30; ++i) x = advanced(coronary, x, {double(i), 1}, 5);
    EXPECT_NEAR(outlet_pressure(coronary, x, 5), b.outlet_pressure.back(), 1e-5);

    const ZeroD c = read_zero_d("steadyFlow_stenosis_R");
    const OutletModel resistance = Resistance{c.outlet.at("R"), c.outlet.at("Pd")};
    EXPECT_NEAR(outlet_pressure(resistance, make_steady_state(resistance, 5), 5), c.outlet_pressure.back(), 1e-5);
}

TEST_F(AgainstSvZeroD, pulsatile_rcr) {
    const ZeroD r = read_zero_d("pulsatileFlow_R_RCR");
    const OutletModel rcr = make_rcr(r.outlet);
    OutletState x{r.outlet_pressure[0] - double(r.outlet.at("Rp")) * r.flow[0], 0};
    double largest = 0;
    for (std::size_t i = 1; i < r.time.size(); ++i) {
        x = advanced(rcr, x, {r.time[i - 1], r.time[i] - r.time[i - 1]}, r.flow[i - 1], r.flow[i]);
        largest = std::max(largest, std::abs(outlet_pressure(rcr, x, r.flow[i]) - r.outlet_pressure[i]));
    }
    // The stored run is of second order in its step of 0.005 s: (w dt)^2 / 6 of the amplitude of p_c, which is
    // 2.5 * 1000 / |1 + i w R_d C| = 2117 (peak pressure 8899).
    const double phase = 2 * std::numbers::pi * 0.005;
    EXPECT_LT(largest, phase * phase / 6 * 2117);
}

TEST_F(AgainstSvFsi, rcr_of_the_pipe) {
    const auto rows = read_rows(reference / "svFSI_pipe_RCR/RCR.dat", 0, 4);   // t, p_c, p, Q
    ASSERT_EQ(rows.size(), 1600u);
    const OutletModel rcr = Rcr{121, 1.5e-4, 1212, 0};
    OutletState x{};
    double q = 0, worst_c = 0, worst_p = 0;
    for (const auto& row : rows) {
        x = advanced(rcr, x, {row[0] - 0.005, 0.005}, q, row[3]);
        q = row[3];
        worst_c = std::max(worst_c, std::abs(x[0] - row[1]));
        worst_p = std::max(worst_p, std::abs(outlet_pressure(rcr, x, q) - row[2]));
    }
    // Seven printed digits: 0.05 of p_c = 1e5, and 5e-5 of Q = 1e2 times at most R_d or R_p.
    EXPECT_LT(worst_c, 0.05 + 5e-5 * 1212);
    EXPECT_LT(worst_p, 0.05 + 5e-5 * (1212 + 121));
}

TEST_F(AgainstSvFsi, outlet_flux_gives_outlet_pressure) {
    const auto flux = read_rows(reference / "svFSI_pipe_RCR/B_NS_Velocity_flux.txt", 3, 3);   // inlet, outlet, wall
    const auto pressure = read_rows(reference / "svFSI_pipe_RCR/B_NS_Pressure_average.txt", 3, 3);
    ASSERT_EQ(flux.size(), 1600u);
    ASSERT_EQ(pressure.size(), 1600u);
    const OutletModel rcr = Rcr{121, 1.5e-4, 1212, 0};
    OutletState x{};
    double q = 0, worst = 0, peak = 0;
    for (std::size_t i = 0; i < flux.size(); ++i) {
        x = advanced(rcr, x, {0.005 * double(i), 0.005}, q, flux[i][1]);
        q = flux[i][1];
        if (i < 20) continue;   // their pressure rings for the first tenth of a second
        // Generalised alpha with spectral radius 0.5: the boundary pressure acts on 2/3 of the new field, 1/3 of the old.
        const double acting = (2 * pressure[i][1] + pressure[i - 1][1]) / 3;
        worst = std::max(worst, std::abs(outlet_pressure(rcr, x, q) - acting));
        peak = std::max(peak, acting);
    }
    EXPECT_LT(worst, 0.001 * peak);   // their traction is imposed weakly; a tenth of our own solver's bar of 1 %
}

TEST(PublishedWaveforms, are_accepted_as_periodic) {
    // Boileau et al. 2015 (carotid, aortic bifurcation; m3/s), and the inflow of the svFSI pipe (mL/s, in negative).
    if (!exists(reference / "boileau2015")) GTEST_SKIP() << "the reference data are not beside this checkout";
    const auto load = [](const char* name, int skip) {
        std::vector<double> times, values;
        for (const auto& row : read_rows(reference / name, skip, 2)) {
            times.push_back(row[0]);
            values.push_back(row[1]);
        }
        return make_waveform(times, values, Interpolation::monotone_cubic, Repeat::periodic);
    };
    const Waveform carotid = load("boileau2015/cca_inlet.dat", 0), aorta = load("boileau2015/ibif_inlet.dat", 0);
    const Waveform pipe = load("svFSI_pipe_RCR/lumen_inlet.flow", 1);
    EXPECT_NEAR(carotid.period().value(), 1.1, 1e-12);
    EXPECT_NEAR(carotid.mean(), 6.5e-6, 0.5e-6);   // the article's mean flow in the carotid, 6.5 mL/s
    EXPECT_GT(aorta.mean(), 0);
    EXPECT_NEAR(pipe(0.0625), -4.782786, 1e-12);
    // Sixteen modes carry a published flow: what they leave is below 1 % of its range at every time.
    for (const Waveform& f : {carotid, aorta, pipe}) {
        const FourierSeries modes = make_fourier_series(f, 16);
        const double period = f.period().value();
        double low = f(0), high = f(0), worst = 0;
        for (int i = 0; i < 1000; ++i) {
            const double t = period * i / 1000;
            low = std::min(low, f(t));
            high = std::max(high, f(t));
            worst = std::max(worst, std::abs(f(t) - modes(t)));
        }
        EXPECT_LT(worst, 0.01 * (high - low));
    }
}

}   // namespace
}   // namespace patency
