// SPDX-License-Identifier: Apache-2.0
#include "patency/stages/waveform_of_deck.h"

#include "patency/base/errors.h"

namespace patency {

Waveform make_signal_waveform(const deck::Waveform& said, const deck::Case& config, Dimension, double factor) {
    if (said.fourier) {
        FourierSeries series{said.fourier->mean * factor, said.fourier->cosines, said.fourier->sines, said.fourier->period};
        for (double& a : series.cosines) a *= factor;
        for (double& a : series.sines) a *= factor;
        return make_waveform(std::move(series));
    }
    std::vector<double> values = said.values;
    if (said.file)
        throw DeckError("waveform.file: files of waveforms come with the table reader; use times and values");
    for (double& v : values) v *= factor;
    const std::optional<double> period = said.period ? said.period : config.about.period;
    return make_waveform(said.times, values, Interpolation::linear, period ? Repeat::periodic : Repeat::once, period);
}

}  // namespace patency
