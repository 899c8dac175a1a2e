// SPDX-License-Identifier: Apache-2.0
// A scalar that depends on time: a constant, a table of (time, value) or a Fourier series, periodic or played once.
// Knows no units (SI by convention: s, m3/s, Pa) and no files.
#pragma once

#include <array>
#include <complex>
#include <cstddef>
#include <optional>
#include <span>
#include <variant>
#include <vector>

namespace patency {

/// f(t) = mean + sum_k cosines[k-1] cos(k w t) + sines[k-1] sin(k w t), w = 2 pi / period, k = 1..modes().
/// Without modes it is a constant, and the period means nothing.
struct FourierSeries {
    double mean = 0;
    std::vector<double> cosines, sines;   // of equal length
    double period = 1;                    // s, > 0

    std::size_t modes() const { return cosines.size(); }
    /// Angular frequency of mode k, k w [rad/s].
    double frequency(std::size_t k) const;
    /// Complex amplitude of mode k >= 1: f_k(t) = Re(amplitude e^(i k w t)), amplitude = cosine - i sine.
    std::complex<double> amplitude(std::size_t k) const { return {cosines[k - 1], -sines[k - 1]}; }
    void set_amplitude(std::size_t k, std::complex<double> a);
    double operator()(double time) const;
};

/// How a table is read between its points.
enum class Interpolation {
    linear,
    monotone_cubic,   ///< continuous slope, no overshoot between points (Fritsch and Butland 1984)
};

/// What a table means outside its own times.
enum class Repeat {
    periodic,   ///< it repeats
    once,       ///< the first and the last value hold
};

class Waveform {
public:
    /// Zero at all times.
    Waveform() = default;

    /// The value at any time, also before zero.
    double operator()(double time) const;
    /// Exact mean over begin..end, begin < end (one step, or any other span).
    double mean(double begin, double end) const;
    /// Mean over a period; of a table played once, over its own times.
    double mean() const;
    /// Made by make_constant or of a series without modes.
    bool is_constant() const;
    /// Length of the period [s]; none for constants and for tables played once.
    std::optional<double> period() const;

private:
    friend Waveform make_constant(double);
    friend Waveform make_waveform(FourierSeries);
    friend Waveform make_waveform(std::span<const double>, std::span<const double>, Interpolation, Repeat,
                                  std::optional<double>);

    /// On times[i]..times[i+1]: value = c[0] + c[1] s + c[2] s^2 + c[3] s^3 with s = time - times[i].
    struct Pieces {
        std::vector<double> times;
        std::vector<double> integrals;   // from times[0] to times[i]
        std::vector<std::array<double, 4>> coefficients;
        Repeat repeat = Repeat::periodic;

        std::size_t find_piece(double time) const;   // time within times.front()..times.back()
        double value(double time) const;
        double integral(double time) const;   // from times[0] to time
    };

    double integral(double time) const;   // from an arbitrary, fixed origin

    std::variant<FourierSeries, Pieces> law_;
};

/// The same value at all times. @throws DeckError if it is not finite.
Waveform make_constant(double value);

/// @throws DeckError if a number is not finite, the period is not positive, or the numbers of cosines and sines differ.
Waveform make_waveform(FourierSeries series);

/// A table: times [s] strictly increasing, at least two points, as many values.
/// A periodic table repeats after `period`; without one, after its own length, and then its last value must equal its
/// first (to 0.1 % of the largest magnitude; the first is used). With a period longer than the table the gap is closed
/// by one more piece from the last value to the first.
/// @throws DeckError on times that do not increase, numbers that are not finite, fewer than two points, lists of unequal
/// length, a table that does not close or is longer than its period.
Waveform make_waveform(std::span<const double> times, std::span<const double> values, Interpolation interpolation,
                       Repeat repeat, std::optional<double> period = {});

/// The first `modes` Fourier modes of a periodic waveform, by the trapezoidal sum over samples equally spaced in time
/// (exact for a band-limited waveform; otherwise the folding error falls with the square of the number of samples).
/// A constant gives a series without modes. @throws DeckError if the waveform is played once.
FourierSeries make_fourier_series(const Waveform& waveform, std::size_t modes);

/// Smooth start: 0 before time 0, (1 - cos(pi t / duration)) / 2, 1 after duration. Its slope is continuous.
/// A duration of zero is a step at time 0.
double smooth_ramp(double time, double duration);

}   // namespace patency
