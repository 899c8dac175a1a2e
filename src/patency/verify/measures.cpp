// SPDX-License-Identifier: Apache-2.0
#include "patency/verify/measures.h"

#include <cassert>
#include <cmath>

namespace patency {

double rmsep_percent(std::span<const double> computed, std::span<const double> exact) {
    assert(computed.size() == exact.size() && !exact.empty());
    double sum = 0;
    for (std::size_t i = 0; i < exact.size(); ++i) {
        const double e = (computed[i] - exact[i]) / exact[i];
        sum += e * e;
    }
    return 100 * std::sqrt(sum / double(exact.size()));
}

double l2_percent(std::span<const double> computed, std::span<const double> exact, double scale) {
    assert(computed.size() == exact.size() && !exact.empty());
    double sum = 0;
    for (std::size_t i = 0; i < exact.size(); ++i) sum += (computed[i] - exact[i]) * (computed[i] - exact[i]);
    return 100 * std::sqrt(sum / double(exact.size())) / scale;
}

double observed_order(double error_1, double spacing_1, double error_2, double spacing_2) {
    return std::log(error_1 / error_2) / std::log(spacing_1 / spacing_2);
}

double SpacingStudy::extrapolated() const {
    const double ratio = spacings[1] / spacings[2];
    return values[2] + (values[2] - values[1]) / (ratio * ratio - 1);
}

double SpacingStudy::convergence_index_percent() const {
    const auto square = [](double h) { return h * h; };
    const double finest = square(spacings[2]);
    const double by_fine = std::abs(values[2] - values[1]) / (square(spacings[1]) - finest) * finest;
    const double by_coarse = std::abs(values[1] - values[0]) / (square(spacings[0]) - square(spacings[1])) * finest;
    return 100 * 1.25 * std::max(by_fine, by_coarse) / std::abs(values[2]);
}

std::complex<double> amplitude(std::span<const double> times, std::span<const double> values,
                               double angular_frequency) {
    assert(times.size() == values.size() && times.size() > 1);
    std::complex<double> integral{};
    for (std::size_t i = 0; i + 1 < times.size(); ++i) {
        const auto turned = [&](std::size_t j) { return values[j] * std::polar(1.0, -angular_frequency * times[j]); };
        integral += 0.5 * (times[i + 1] - times[i]) * (turned(i) + turned(i + 1));
    }
    return 2.0 / (times.back() - times.front()) * integral;
}

double decay_rate(std::span<const double> times, std::span<const double> values) {
    assert(times.size() == values.size() && times.size() > 1);
    const double count = double(times.size());
    double mean_time = 0, mean_log = 0, top = 0, bottom = 0;
    for (std::size_t i = 0; i < times.size(); ++i) {
        mean_time += times[i] / count;
        mean_log += std::log(values[i]) / count;
    }
    for (std::size_t i = 0; i < times.size(); ++i) {
        top += (times[i] - mean_time) * (std::log(values[i]) - mean_log);
        bottom += (times[i] - mean_time) * (times[i] - mean_time);
    }
    return -top / bottom;
}

}   // namespace patency
