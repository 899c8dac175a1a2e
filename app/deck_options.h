// SPDX-License-Identifier: Apache-2.0
// The options that every command with a deck has, and the case they choose.
#pragma once

#include <string>

#include "patency/config/deck.h"

namespace patency::app {

class Command;

struct DeckOptions {
    std::string path;
    deck::Settings settings;   ///< --set key=value
    std::string run;           ///< --run NAME
    int threads = 0;           ///< --threads; 0: the deck's

    void add_to(const Command& command);
    /// The deck, with the settings over it; of a deck with runs the one asked for. Throws DeckError, FileError, UsageError.
    deck::Case read() const;
    /// Bounds the threads: --threads, else numerics.threads, else one per core. Returns how many there are.
    int apply_threads(const deck::Case& config) const;
    /// The same, and a line that begins a log: "case.yaml on 2 threads".
    std::string title(const deck::Case& config) const;
};

/// "1 thread", "2 threads".
std::string thread_text(int threads);

}   // namespace patency::app
