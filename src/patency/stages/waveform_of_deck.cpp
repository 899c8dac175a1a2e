// SPDX-License-Identifier: Apache-2.0
#include "patency/stages/waveform_of_deck.h"

#include <fmt/format.h>

#include <string>

#include "patency/base/errors.h"
#include "patency/io/csv.h"

namespace patency {

namespace {

/// The unit at the end of a column's name: flow_mL_per_min -> mL/min.
const Unit& unit_of_column(const std::string& name, Dimension dimension, const std::string& file) {
    for (std::size_t at = name.find('_'); at != std::string::npos; at = name.find('_', at + 1)) {
        std::string spelling = name.substr(at + 1);
        for (std::size_t per = spelling.find("_per_"); per != std::string::npos; per = spelling.find("_per_"))
            spelling.erase(per + 1, 4)[per] = '/';
        const Unit* unit = find_unit(spelling);
        if (unit && unit->dimension == dimension) return *unit;
    }
    throw DeckError(fmt::format("{}: column '{}' must end in a unit of {}, as in {}", file, name,
                                dimension_name(dimension),
                                dimension == Dimension::time ? "time_s" : "flow_mL_per_min or pressure_mmHg"));
}

}   // namespace

Waveform make_signal_waveform(const deck::Waveform& said, const deck::Case& config, Dimension dimension,
                              double factor) {
    if (said.fourier) {
        FourierSeries series{said.fourier->mean * factor, said.fourier->cosines, said.fourier->sines,
                             said.fourier->period};
        for (double& a : series.cosines) a *= factor;
        for (double& a : series.sines) a *= factor;
        return make_waveform(std::move(series));
    }
    std::vector<double> times = said.times, values = said.values;
    if (said.file) {
        const CsvTable table = read_csv(*said.file);
        if (table.columns.size() < 2)
            throw DeckError(fmt::format("{}: a time column and a value column are needed", said.file->string()));
        const Unit& second = unit_of_column(table.names[0], Dimension::time, said.file->string());
        const Unit& unit = unit_of_column(table.names[1], dimension, said.file->string());
        times = table.columns[0];
        values = table.columns[1];
        for (double& t : times) t = t * second.numerator / second.denominator;
        for (double& v : values) v = v * unit.numerator / unit.denominator;
    }
    for (double& v : values) v *= factor;
    const std::optional<double> period = said.period ? said.period : config.about.period;
    return make_waveform(times, values, Interpolation::linear, period ? Repeat::periodic : Repeat::once, period);
}

}   // namespace patency
