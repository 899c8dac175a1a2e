// SPDX-License-Identifier: Apache-2.0
// The deck's schema as a document, for editors (JSON Schema) and for the user guide (Markdown). Both follow
// from the one table in schema.cpp; reading decks is deck.h's business.
#pragma once

#include <filesystem>
#include <string>

namespace patency::deck {

/// JSON Schema, draft-07. Units, choices, required and excluded keys are in it; ranges of quantities and the
/// checks across keys are not, since a schema does not compute.
std::string schema_json();
/// One section per record, one table row per key.
std::string schema_markdown();

/// The same into files; throw FileError.
void write_json_schema(const std::filesystem::path& path);
void write_schema_markdown(const std::filesystem::path& path);

}   // namespace patency::deck
