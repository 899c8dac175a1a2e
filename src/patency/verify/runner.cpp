// SPDX-License-Identifier: Apache-2.0
#include "patency/verify/runner.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <ctime>
#include <nlohmann/json.hpp>
#include <set>

#include "patency/base/errors.h"
#include "patency/base/text.h"
#include "patency/config/deck.h"
#include "patency/io/atomic_file.h"
#include "patency/io/hash.h"
#include "patency/stages/build.h"
#include "patency/verify/cpu_time.h"

namespace patency {

namespace {

namespace fs = std::filesystem;

void make_folder(const fs::path& path) {
    std::error_code error;
    fs::create_directories(path, error);
    if (error) throw FileError("cannot make the folder '" + path.string() + "': " + error.message());
}

std::vector<const VerifyCase*> choose_cases(const VerifyRequest& request) {
    std::vector<std::string> known;
    for (const VerifyCase& c : verification_cases()) known.push_back(c.name);
    for (const std::string& name : request.names)
        if (std::find(known.begin(), known.end(), name) == known.end()) {
            const std::string nearest = nearest_name(name, known);
            throw UsageError(fmt::format("there is no verification case {}{}; there are {}", name,
                                         nearest.empty() ? "" : ", did you mean " + nearest + "?",
                                         join(known, ", ", " and ")));
        }
    std::vector<const VerifyCase*> chosen;
    for (const VerifyCase& c : verification_cases()) {
        const bool is_named = std::find(request.names.begin(), request.names.end(), c.name) != request.names.end();
        if (is_named || (request.names.empty() && (c.level == Level::quick || request.level == Level::full)))
            chosen.push_back(&c);
    }
    return chosen;
}

class CaseRunner {
public:
    CaseRunner(const VerifyRequest& request, const VerifyCase& c) : request_(request), case_(c) {}

    CaseReport run() {
        std::map<std::string, RunData> runs;
        if (case_.measure || case_.measure_cells || case_.measure_solids) {
            make_folder(folder());
            const fs::path deck = request_.decks / (case_.name + ".yaml");
            for (const deck::NamedCase& run : deck::read_runs(deck, request_.settings))
                if (request_.level == Level::full || !case_.is_full || !case_.is_full(run.name))
                    runs[run.name] = find_or_do(run);
        }
        CaseReport report{.name = case_.name, .level = request_.level, .particles = 0, .figures = {}};
        nlohmann::ordered_json timing;
        timing["name"] = case_.name;
        timing["date"] = fmt::format("{:%Y-%m-%d}", fmt::gmtime(std::time(nullptr)));
        timing["cpu_s"] = timing["wall_s"] = 0.0;
        for (const auto& [name, run] : runs) {
            report.particles = std::max(report.particles, run.particles);
            timing["cpu_s"] = timing["cpu_s"].get<double>() + run.cpu_s;
            timing["wall_s"] = timing["wall_s"].get<double>() + run.wall_s;
            timing["runs"][name] = {{"particles", run.particles},
                                    {"acoustic_steps", run.acoustic_steps},
                                    {"cpu_s", run.cpu_s},
                                    {"wall_s", run.wall_s},
                                    {"particle_steps_per_cpu_s", run.particle_steps / std::max(run.cpu_s, 1e-9)}};
        }
        const Results results(std::move(runs), request_.reference);
        FigureList figures(results);
        case_.figures(results, figures);
        report.figures = figures.take();
        if (case_.pictures) write_pictures(case_.pictures(results));
        write_file(request_.out / (case_.name + ".json"), format_report(report));
        write_file(request_.out / (case_.name + ".timing.json"), timing.dump(1) + "\n");
        return report;
    }

private:
    fs::path folder() const { return request_.out / "runs" / case_.name; }

    void write_pictures(const std::vector<Picture>& pictures) const {
        make_folder(request_.out / "pictures");
        nlohmann::ordered_json captions = nlohmann::ordered_json::array();
        for (const Picture& p : pictures) {
            write_file(request_.out / "pictures" / (p.name + ".svg"), p.svg);
            captions.push_back({{"name", p.name}, {"caption", p.caption}});
        }
        write_file(request_.out / "pictures" / (case_.name + ".json"), captions.dump(1) + "\n");
    }

    RunData find_or_do(const deck::NamedCase& named) {
        const std::string key = hex_text(hash_bytes(request_.program + "\n" + deck::format_case(named.resolved)));
        const fs::path file = folder() / (named.name + ".json");
        VerifyProgress progress{case_.name, named.name};
        if (!request_.fresh && fs::exists(file))
            if (auto kept = parse_run(read_file(file)); kept && kept->key == key) {
                progress.done = &*kept;
                progress.is_reused = true;
                if (request_.report) request_.report(progress);
                return *kept;
            }
        RunData data = do_run(named);
        data.key = key;
        write_file(file, format_run(data));
        progress.done = &data;
        if (request_.report) request_.report(progress);
        return data;
    }

    RunData do_run(const deck::NamedCase& named) {
        RunData data;
        const double cpu = cpu_seconds();
        const auto start = std::chrono::steady_clock::now();
        const auto stop_if_asked = [&] {
            if (request_.interrupted && request_.interrupted())
                throw Error(ExitCode::interrupted,
                            "the verification was interrupted; the same command goes on with it");
        };
        try {
            if (case_.measure_cells) {
                case_.measure_cells(named.resolved, named.name, request_.reference, request_.interrupted, data);
                stop_if_asked();
            } else if (case_.measure_solids) {
                case_.measure_solids(named.resolved, named.name, request_.interrupted, data);
                stop_if_asked();
            } else {
                measure_particles(named, stop_if_asked, data);
            }
        } catch (const DivergedError& error) {
            data.failure = error.what();
        }
        data.cpu_s = cpu_seconds() - cpu;
        data.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        return data;
    }

    void measure_particles(const deck::NamedCase& named, const std::function<void()>& stop_if_asked,
                           RunData& data) const {
        const auto scene = build_scene(named.resolved);
        for (const std::int32_t opening : scene->fluid.opening) data.particles += opening == 0;
        std::int64_t steps = 0;
        const auto watch = [&](const Scene& now) {
            data.particle_steps += double(now.fluid.size()) * double(now.acoustic_steps - steps);
            steps = now.acoustic_steps;
            if (request_.report) request_.report({case_.name, named.name, now.time / named.resolved.numerics.duration});
            stop_if_asked();
        };
        case_.measure(*scene, {named.name, request_.reference, watch}, data);
        data.acoustic_steps = scene->acoustic_steps;
    }

    const VerifyRequest& request_;
    const VerifyCase& case_;
};

}   // namespace

std::vector<std::string> names_of_verification(const VerifyRequest& request) {
    std::vector<std::string> names;
    for (const VerifyCase* c : choose_cases(request)) names.push_back(c->name);
    return names;
}

std::vector<CaseReport> run_verification(const VerifyRequest& request) {
    const auto cases = choose_cases(request);
    make_folder(request.out);
    std::vector<CaseReport> reports;
    for (const VerifyCase* c : cases) reports.push_back(CaseRunner(request, *c).run());
    return reports;
}

}   // namespace patency
