// SPDX-License-Identifier: Apache-2.0
#include "patency/stages/solid_checkpoint.h"

#include <fmt/format.h>

#include "patency/base/errors.h"

namespace patency {

void write_solids(CheckpointWriter& writer, const SolidSystem& system, const std::string& name) {
    for (const auto& part : system.parts) {
        const std::string own = name + "/parts/" + part->name;
        writer.write(part->body->particles(), own + "/particles");
        writer.write(own + "/body", part->body->state());
        writer.write(own + "/stride", std::int64_t(part->stride));
    }
    for (std::size_t k = 0; k < system.contacts.size(); ++k)
        writer.write(fmt::format("{}/contacts/{}", name, k), system.contacts[k]->state());
}

void read_solids(const CheckpointReader& reader, SolidSystem& system, const std::string& name) {
    for (auto& part : system.parts) {
        const std::string own = name + "/parts/" + part->name;
        const std::size_t count = part->body->particles().size();
        reader.read(part->body->particles(), own + "/particles");
        if (part->body->particles().size() != count)
            throw CheckpointError(fmt::format("{} has {} particles in the checkpoint and {} in this deck", part->name,
                                              part->body->particles().size(), count));
        part->body->restore(reader.read<std::vector<double>>(own + "/body"));
        part->stride = int(reader.read<std::int64_t>(own + "/stride"));
        if (part->surface) part->surface->follow(part->body->particles());
    }
    for (std::size_t k = 0; k < system.contacts.size(); ++k) {
        const auto state = reader.read<std::vector<double>>(fmt::format("{}/contacts/{}", name, k));
        system.contacts[k]->restore(state);
    }
}

void write_solid_checkpoint(const std::filesystem::path& path, const CheckpointOrigin& origin,
                            const SolidScene& scene) {
    CheckpointWriter writer(path, origin);
    write_solids(writer, scene.system, "solids");
    writer.write("time", scene.time);
    writer.write("dt", scene.dt);
    writer.write("steps", scene.steps);
    writer.finish();
}

void read_solid_checkpoint(const CheckpointReader& reader, SolidScene& scene) {
    read_solids(reader, scene.system, "solids");
    scene.time = reader.read<double>("time");
    scene.dt = reader.read<double>("dt");
    scene.steps = reader.read<std::int64_t>("steps");
}

}   // namespace patency
