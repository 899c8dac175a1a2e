// SPDX-License-Identifier: Apache-2.0
#include "patency/physics/open_ends/heartbeat.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "patency/base/errors.h"
#include "patency/physics/open_ends/outlets.h"

namespace patency {

namespace {

constexpr double shortest = 1.0 / 3, longest = 2;   // s: 180 and 30 beats a minute
constexpr int instants = 400;                       // 2 ms at 75 beats a minute: an ejection has a hundred of them

// The ventricle's times: ejection after Weissler et al., Circulation 1968; 37: 149 (men); its pressure rises in about 50 ms and falls
// with a time constant of about 40 ms from and to a filling pressure of 8 mmHg.
constexpr double rise = 0.05, fall = 0.04, filling_pressure = 8 * 133.322;
double ejection_time(double period) { return 0.413 - 0.0017 * 60 / period; }

// The aorta's characteristic impedance is some 5 to 10 % of the resistance behind it: 6 % at 40 of 93 mmHg and 75 beats a minute. Its
// pressure is so much of the pulse at the height of the ejection at any other, so that every pulse has about the same form.
constexpr double share_of_impedance = 0.6;

/// What the ventricle ejects at most, over its mean.
double largest_ejection(double period) { return 0.5 * std::numbers::pi * period / ejection_time(period); }

/// What it ejects at an instant.
double ejection(double time, double period) {
    const double s = (time - rise) / ejection_time(period);
    return s > 0 && s < 1 ? largest_ejection(period) * std::sin(std::numbers::pi * s) : 0;
}

/// Over its mean, for the time in which the arteries run empty.
std::vector<double> aortic_pressure(double impedance, double decay, double period) {
    const Rcr arteries{impedance, decay, 1, 0};   // in units of the mean flow and of the distal resistance
    const double step = period / instants;
    const auto end_of_beat = [&](OutletState state, std::vector<double>* pressures) {
        for (int k = 0; k <= instants; ++k) {
            const double now = ejection(k * step, period), next = ejection((k + 1) * step, period);
            if (pressures) pressures->push_back(outlet_pressure(arteries, state, now) / (1 + impedance));
            if (k < instants) state = advanced(arteries, state, {k * step, step}, now, next);
        }
        return state;
    };
    // A beat from an empty aorta tells where it repeats: what is there at first decays, whatever is ejected.
    const OutletState repeating{end_of_beat({}, nullptr)[0] / -std::expm1(-period / decay), 0};
    std::vector<double> pressures;
    end_of_beat(repeating, &pressures);
    return pressures;
}

double swing(const std::vector<double>& values) {
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    return *high - *low;
}

}   // namespace

BeatPressures make_beat(const Heartbeat& beat) {
    if (!(beat.period >= shortest && beat.period <= longest))
        throw DeckError("case.period: a heartbeat takes 0.33 to 2 s; give the waveforms of what is none");
    if (!(beat.pulse > 0 && beat.pulse < beat.mean))
        throw DeckError("aorta.pulse: must be more than nothing and less than aorta.pressure, the mean");
    const double relative = beat.pulse / beat.mean,
                 impedance = share_of_impedance * relative / largest_ejection(beat.period);
    // The emptier the arteries run, the larger is the pulse: the decay between a twentieth of a beat and a thousand beats.
    double low = 0.05 * beat.period, high = 1000 * beat.period;
    for (int halving = 0; halving < 60; ++halving) {
        const double middle = std::sqrt(low * high);
        (swing(aortic_pressure(impedance, middle, beat.period)) > relative ? low : high) = middle;
    }
    BeatPressures result{{}, aortic_pressure(impedance, high, beat.period), {}, high};
    for (double& p : result.aorta) p *= beat.mean;
    const double step = beat.period / instants, closing = rise + ejection_time(beat.period);
    const auto aorta_at = [&](double time) {
        const double place = time / step;
        const auto k = std::size_t(place);
        return result.aorta[k] + (place - double(k)) * (result.aorta[k + 1] - result.aorta[k]);
    };
    const double opening_pressure = aorta_at(rise) - filling_pressure,
                 closing_pressure = aorta_at(closing) - filling_pressure;
    for (int k = 0; k <= instants; ++k) {
        const double t = k * step;
        result.times.push_back(t);
        const double above = t < rise       ? 0.5 * opening_pressure * (1 - std::cos(std::numbers::pi * t / rise))
                             : t <= closing ? result.aorta[std::size_t(k)] - filling_pressure
                                            : closing_pressure * std::exp((closing - t) / fall);
        result.ventricle.push_back(filling_pressure + above);
    }
    result.aorta.back() = result.aorta.front(), result.ventricle.back() = result.ventricle.front();
    return result;
}

}   // namespace patency
