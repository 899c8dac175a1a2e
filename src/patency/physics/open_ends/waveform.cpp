// SPDX-License-Identifier: Apache-2.0
#include "patency/physics/open_ends/waveform.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "patency/base/errors.h"

namespace patency {
namespace {

constexpr double pi = std::numbers::pi;

void expect_finite(std::span<const double> numbers, const std::string& what) {
    for (std::size_t i = 0; i < numbers.size(); ++i)
        if (!std::isfinite(numbers[i]))
            throw DeckError("a waveform's " + what + " number " + std::to_string(i + 1) +
                            " is not a finite number; correct or remove it");
}

void expect_table(std::span<const double> times, std::span<const double> values) {
    if (times.size() != values.size())
        throw DeckError("a waveform has " + std::to_string(times.size()) + " times but " +
                        std::to_string(values.size()) + " values; give one value per time");
    if (times.size() < 2)
        throw DeckError("a waveform table needs at least two points; for a constant give a single value instead");
    expect_finite(times, "time");
    expect_finite(values, "value");
    for (std::size_t i = 1; i < times.size(); ++i)
        if (!(times[i] > times[i - 1]))
            throw DeckError("a waveform's times must increase, but time number " + std::to_string(i + 1) + " (" +
                            std::to_string(times[i]) + " s) is not after " + std::to_string(times[i - 1]) +
                            " s; sort the table");
}

/// Makes a periodic table end where it began, one period later.
void close_table(std::vector<double>& times, std::vector<double>& values, std::optional<double> period) {
    const double length = times.back() - times.front();
    if (period && !(std::isfinite(*period) && *period > 0))
        throw DeckError("a waveform's period must be a positive time, not " + std::to_string(*period) + " s");
    constexpr double slack = 1e-9;   // a period written with fewer digits than the times
    if (period && *period > length * (1 + slack)) {
        times.push_back(times.front() + *period);
        values.push_back(values.front());
        return;
    }
    if (period && *period < length * (1 - slack))
        throw DeckError("a waveform's table is " + std::to_string(length) + " s long, more than its period of " +
                        std::to_string(*period) + " s; cut the table or correct the period");
    double largest = 0;
    for (double v : values) largest = std::max(largest, std::abs(v));
    constexpr double tolerance = 1e-3;   // of the largest magnitude: rounding in published tables
    if (std::abs(values.back() - values.front()) > tolerance * largest)
        throw DeckError("a periodic waveform must end with the value it starts with, but it starts with " +
                        std::to_string(values.front()) + " and ends with " + std::to_string(values.back()) +
                        "; repeat the first point at the end, give a period, or let it play once");
    values.back() = values.front();
}

/// Slopes at the points such that the cubic through two of them stays between their values: the weighted harmonic mean
/// of the neighbouring chords, zero where they differ in sign (Fritsch and Butland 1984).
std::vector<double> make_monotone_slopes(std::span<const double> times, std::span<const double> values, Repeat repeat) {
    const std::size_t count = times.size();
    std::vector<double> width(count - 1), chord(count - 1), slopes(count);
    for (std::size_t i = 0; i + 1 < count; ++i) {
        width[i] = times[i + 1] - times[i];
        chord[i] = (values[i + 1] - values[i]) / width[i];
    }
    const auto slope = [&](std::size_t left, std::size_t right) {
        if (chord[left] * chord[right] <= 0) return 0.0;
        const double a = 2 * width[right] + width[left], b = width[right] + 2 * width[left];
        return (a + b) / (a / chord[left] + b / chord[right]);
    };
    for (std::size_t i = 1; i + 1 < count; ++i) slopes[i] = slope(i - 1, i);
    if (repeat == Repeat::periodic) {
        slopes.front() = slopes.back() = slope(count - 2, 0);
    } else {
        slopes.front() = chord.front();   // a chord is at most three times itself: still monotone
        slopes.back() = chord.back();
    }
    return slopes;
}

}   // namespace

double FourierSeries::frequency(std::size_t k) const { return 2 * pi * double(k) / period; }

void FourierSeries::set_amplitude(std::size_t k, std::complex<double> a) {
    cosines[k - 1] = a.real();
    sines[k - 1] = -a.imag();
}

double FourierSeries::operator()(double time) const {
    double sum = mean;
    for (std::size_t k = 1; k <= modes(); ++k) {
        const double phase = 2 * pi * double(k) * (time / period - std::floor(time / period));
        sum += cosines[k - 1] * std::cos(phase) + sines[k - 1] * std::sin(phase);
    }
    return sum;
}

std::size_t Waveform::Pieces::find_piece(double time) const {
    const auto after = std::upper_bound(times.begin() + 1, times.end() - 1, time);
    return std::size_t(after - times.begin()) - 1;
}

double Waveform::Pieces::value(double time) const {
    const std::size_t i = find_piece(time);
    const auto& c = coefficients[i];
    const double s = time - times[i];
    return c[0] + s * (c[1] + s * (c[2] + s * c[3]));
}

double Waveform::Pieces::integral(double time) const {
    const std::size_t i = find_piece(time);
    const auto& c = coefficients[i];
    const double s = time - times[i];
    return integrals[i] + s * (c[0] + s * (c[1] / 2 + s * (c[2] / 3 + s * c[3] / 4)));
}

double Waveform::operator()(double time) const {
    if (const auto* series = std::get_if<FourierSeries>(&law_)) return (*series)(time);
    const auto& pieces = std::get<Pieces>(law_);
    const double begin = pieces.times.front(), end = pieces.times.back();
    if (pieces.repeat == Repeat::once) return pieces.value(std::clamp(time, begin, end));
    const double length = end - begin;
    return pieces.value(std::clamp(time - length * std::floor((time - begin) / length), begin, end));
}

double Waveform::integral(double time) const {
    if (const auto* series = std::get_if<FourierSeries>(&law_)) {
        double sum = series->mean * time;
        for (std::size_t k = 1; k <= series->modes(); ++k) {
            const double w = series->frequency(k);
            sum += (series->cosines[k - 1] * std::sin(w * time) - series->sines[k - 1] * std::cos(w * time)) / w;
        }
        return sum;
    }
    const auto& pieces = std::get<Pieces>(law_);
    const double begin = pieces.times.front(), end = pieces.times.back();
    if (pieces.repeat == Repeat::once) {
        const double inside = std::clamp(time, begin, end);
        return pieces.integral(inside) + pieces.value(inside) * (time - inside);
    }
    const double length = end - begin, turns = std::floor((time - begin) / length);
    return turns * pieces.integrals.back() + pieces.integral(std::clamp(time - turns * length, begin, end));
}

double Waveform::mean(double begin, double end) const { return (integral(end) - integral(begin)) / (end - begin); }

double Waveform::mean() const {
    if (const auto* series = std::get_if<FourierSeries>(&law_)) return series->mean;
    const auto& pieces = std::get<Pieces>(law_);
    return pieces.integrals.back() / (pieces.times.back() - pieces.times.front());
}

bool Waveform::is_constant() const {
    const auto* series = std::get_if<FourierSeries>(&law_);
    return series && series->modes() == 0;
}

std::optional<double> Waveform::period() const {
    if (is_constant()) return std::nullopt;
    if (const auto* series = std::get_if<FourierSeries>(&law_)) return series->period;
    const auto& pieces = std::get<Pieces>(law_);
    if (pieces.repeat == Repeat::once) return std::nullopt;
    return pieces.times.back() - pieces.times.front();
}

Waveform make_constant(double value) { return make_waveform(FourierSeries{value, {}, {}, 1}); }

Waveform make_waveform(FourierSeries series) {
    if (series.cosines.size() != series.sines.size())
        throw DeckError("a Fourier waveform has " + std::to_string(series.cosines.size()) + " cosines but " +
                        std::to_string(series.sines.size()) + " sines; give as many of each (zeros where none)");
    if (!(std::isfinite(series.period) && series.period > 0))
        throw DeckError("a Fourier waveform's period must be a positive time, not " + std::to_string(series.period) +
                        " s");
    expect_finite(std::span(&series.mean, 1), "mean");
    expect_finite(series.cosines, "cosine");
    expect_finite(series.sines, "sine");
    Waveform waveform;
    waveform.law_ = std::move(series);
    return waveform;
}

Waveform make_waveform(std::span<const double> times, std::span<const double> values, Interpolation interpolation,
                       Repeat repeat, std::optional<double> period) {
    expect_table(times, values);
    std::vector<double> t(times.begin(), times.end()), v(values.begin(), values.end());
    if (repeat == Repeat::periodic)
        close_table(t, v, period);
    else if (period)
        throw DeckError("a waveform that plays once has no period; remove the period or make it periodic");

    std::vector<double> slopes;
    if (interpolation == Interpolation::monotone_cubic) slopes = make_monotone_slopes(t, v, repeat);
    Waveform::Pieces pieces;
    pieces.repeat = repeat;
    pieces.integrals = {0.0};
    for (std::size_t i = 0; i + 1 < t.size(); ++i) {
        const double width = t[i + 1] - t[i], chord = (v[i + 1] - v[i]) / width;
        std::array<double, 4> c{v[i], chord, 0, 0};
        if (!slopes.empty())   // the cubic with these end values and end slopes
            c = {v[i], slopes[i], (3 * chord - 2 * slopes[i] - slopes[i + 1]) / width,
                 (slopes[i] + slopes[i + 1] - 2 * chord) / (width * width)};
        pieces.coefficients.push_back(c);
        pieces.integrals.push_back(pieces.integrals.back() +
                                   width * (c[0] + width * (c[1] / 2 + width * (c[2] / 3 + width * c[3] / 4))));
    }
    pieces.times = std::move(t);
    Waveform waveform;
    waveform.law_ = std::move(pieces);
    return waveform;
}

FourierSeries make_fourier_series(const Waveform& waveform, std::size_t modes) {
    const auto period = waveform.period();
    FourierSeries series{.mean = waveform.mean(), .cosines = {}, .sines = {}, .period = period.value_or(1.0)};
    if (waveform.is_constant()) return series;
    if (!period) throw DeckError("a waveform that plays once has no Fourier series; make it periodic");
    const std::size_t samples = std::max<std::size_t>(4096, 64 * modes);
    series.cosines.assign(modes, 0.0);
    series.sines.assign(modes, 0.0);
    for (std::size_t j = 0; j < samples; ++j) {
        const double value = waveform(*period * double(j) / double(samples)) * 2 / double(samples);
        for (std::size_t k = 1; k <= modes; ++k) {
            const double phase = 2 * pi * double((j * k) % samples) / double(samples);
            series.cosines[k - 1] += value * std::cos(phase);
            series.sines[k - 1] += value * std::sin(phase);
        }
    }
    return series;
}

double smooth_ramp(double time, double duration) {
    if (time < 0) return 0;
    if (time >= duration) return 1;
    return 0.5 * (1 - std::cos(pi * time / duration));
}

}   // namespace patency
