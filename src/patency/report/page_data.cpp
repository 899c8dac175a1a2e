// SPDX-License-Identifier: Apache-2.0
#include "patency/report/page_data.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numeric>

#include "patency/io/encode.h"
#include "patency/report/colours.h"
#include "patency/report/same_places.h"
#include "patency/report/view.h"
#include "patency/shape/decimate.h"

namespace patency {

namespace {

using Json = nlohmann::ordered_json;

// Together below 5 MB for a run of three parts (tests/report/page_test.cpp).
constexpr std::size_t most_wall_triangles = 40'000, most_cut_triangles = 20'000, most_streamline_points = 20'000,
                      most_body_triangles = 12'000, most_body_points = 8'000;
constexpr double finest_value = no_value - 1;

const std::vector<FieldChoice> wall_fields = {
    {"FFR", "FFR"}, {"Pressure", "Pressure"}, {"WSS", "WSS"}, {"TAWSS", "TAWSS"}, {"OSI", "OSI"}};
const std::vector<FieldChoice> flow_fields = {{"Velocity", "Velocity"}, {"Pressure", "Pressure"}};
const std::vector<FieldChoice> body_fields = {{"VonMises_stress", "VonMises"},
                                              {"PlasticStrain", "PlasticStrain"},
                                              {"Gap", "Gap"},
                                              {"Displacement", "Displacement"}};

const PointArray* find(const PolyData& data, std::string_view name) {
    for (const PointArray& array : data.arrays)
        if (array.name == name) return &array;
    return nullptr;
}

double magnitude(const PointArray& array, std::size_t point) {
    const double* v = &array.values[point * std::size_t(array.components)];
    if (array.components == 1) return *v;
    double sum = 0;
    for (int c = 0; c < array.components; ++c) sum += v[c] * v[c];
    return std::sqrt(sum);
}

void append_positions(Piece& piece, const PolyData& data, const std::vector<std::uint32_t>& points) {
    Vec3 low{INFINITY, INFINITY, INFINITY}, high = -low;
    for (std::uint32_t p : points) {
        const Vec3& x = data.points[p];
        low = {std::min(low.x, x.x), std::min(low.y, x.y), std::min(low.z, x.z)};
        high = {std::max(high.x, x.x), std::max(high.y, x.y), std::max(high.z, x.z)};
    }
    const double widest = std::max({high.x - low.x, high.y - low.y, high.z - low.z, 1e-9}), scale = no_value / widest;
    for (std::uint32_t p : points) {
        const Vec3 x = scale * (data.points[p] - low);
        for (const double value : {x.x, x.y, x.z}) piece.words.push_back(std::uint16_t(std::lround(value)));
    }
    piece.origin = 1e3 * low;
    piece.step = 1e3 / scale;
}

void append_field(Piece& piece, const PolyData& data, const std::vector<std::uint32_t>& points,
                  const FieldChoice& choice) {
    const PointArray* array = find(data, choice.array);
    if (!array) return;
    const PointArray* resolved = find(data, "IsResolved");
    std::vector<double> values;
    double low = INFINITY, high = -INFINITY;
    for (std::uint32_t p : points) {
        const bool is_known = !resolved || resolved->values[p] != 0;
        values.push_back(is_known ? magnitude(*array, p) : NAN);
        if (is_known) low = std::min(low, values.back()), high = std::max(high, values.back());
    }
    if (!(low <= high)) low = high = 0;
    const double scale = high > low ? finest_value / (high - low) : 0;
    for (double v : values)
        piece.words.push_back(std::isnan(v) ? no_value : std::uint16_t(std::lround((v - low) * scale)));
    piece.fields.push_back({choice.name, array->unit, low, high});
}

std::string bytes_of(const std::vector<std::uint16_t>& words) {
    std::string bytes;
    for (const std::uint16_t w : words)
        bytes += char(w & 255), bytes += char(w >> 8);   // the low byte first, on every machine
    return bytes;
}

Json add(PageData& page, const Piece& piece) {
    Json about{{"data", fmt::format("data-{}", page.blobs.size())},
               {"points", piece.points},
               {"triangles", piece.triangles},
               {"lines", piece.lines},
               {"origin_mm", {piece.origin.x, piece.origin.y, piece.origin.z}},
               {"step_mm", piece.step},
               {"fields", Json::array()}};
    for (const PieceField& f : piece.fields)
        about["fields"].push_back({{"name", f.name}, {"unit", f.unit}, {"low", f.low}, {"high", f.high}});
    page.blobs.push_back({about["data"], base64(deflated(bytes_of(piece.words)))});
    return about;
}

/// The arcs that matter along the line that passes a lesion [mm].
Json lesion_model(const Json& lesion) {
    const double start = start_arc_mm(lesion), end = start + lesion.value("length_mm", 0.0);
    return {{"branch", lesion.value("branch", "")},
            {"throat_mm", lesion.value("throat_arc_mm", 0.0)},
            {"start_mm", start},
            {"end_mm", end},
            {"read_mm", lesion.value("read_arc_mm", end)},
            {"flow_m3_per_s", lesion.value("flow_m3_per_s", 0.0)}};
}

/// Where along the vessel the stent lies [mm]; null without one.
Json stent_model(const Json& summary) {
    const std::optional<StentSpan> span = stent_span(summary);
    return span ? Json{{"start_mm", span->start}, {"end_mm", span->end}} : Json(nullptr);
}

Json flow_model(PageData& page, const FlowPart& flow, const Json& summary) {
    Json model{{"key", flow.key}, {"title", flow.title}, {"pieces", Json::object()}, {"lesions", Json::array()}};
    if (flow.wall)
        model["pieces"]["wall"] = add(page, make_piece(*flow.wall, shown_surface(*flow.wall, most_wall_triangles),
                                                       wall_fields, Joints::included));
    if (flow.cut)
        model["pieces"]["cut"] = add(
            page, make_piece(*flow.cut, shown_surface(*flow.cut, most_cut_triangles), flow_fields, Joints::included));
    if (flow.streamlines)
        model["pieces"]["streamlines"] =
            add(page, make_piece(*flow.streamlines, shown_lines(*flow.streamlines, most_streamline_points), flow_fields,
                                 Joints::included));
    if (summary.contains("lesions"))
        for (const Json& lesion : summary["lesions"]) model["lesions"].push_back(lesion_model(lesion));
    return model;
}

bool are_alike(const PolyData& a, const PolyData& b) {
    return a.points.size() == b.points.size() && a.triangles == b.triangles;
}

/// Frames of one body share their triangles: those of the first are decimated, and no point moves by that.
Json body_model(PageData& page, const DeployedBody& body) {
    Json model{{"name", body.name}, {"frames", Json::array()}};
    Shown shown;
    for (std::size_t k = 0; k < body.frames.size(); ++k) {
        const PolyData& frame = body.frames[k];
        const bool is_new = k == 0 || !are_alike(frame, body.frames[k - 1]);
        if (is_new)
            shown = frame.triangles.empty() ? shown_points(frame, most_body_points)
                                            : shown_surface(frame, most_body_triangles);
        Json about = add(page, make_piece(frame, shown, body_fields, is_new ? Joints::included : Joints::left_out));
        about["time_s"] = body.times[k];
        model["frames"].push_back(std::move(about));
    }
    return model;
}

Json colour_table() {
    Json table = Json::array();
    for (int k = 0; k < 256; ++k)
        for (const std::uint8_t c : colour_of(k / 255.0)) table.push_back(c);
    return table;
}

}   // namespace

Shown shown_surface(const PolyData& data, std::size_t most_triangles) {
    Decimated few = decimate(data.points, data.triangles, most_triangles);
    if (few.kept.size() > no_value) throw std::logic_error("a surface of so few triangles has fewer points");
    return {.points = std::move(few.kept), .triangles = std::move(few.triangles)};
}

Shown shown_lines(const PolyData& data, std::size_t most_points) {
    std::size_t total = 0;
    for (const auto& line : data.lines) total += line.size();
    const std::size_t every = (total + most_points - 1) / std::max<std::size_t>(1, most_points);
    Shown shown;
    for (const auto& line : data.lines) {
        const std::size_t before = shown.points.size();
        for (std::size_t k = 0; k < line.size(); ++k)
            if (k % std::max<std::size_t>(1, every) == 0 || k + 1 == line.size()) shown.points.push_back(line[k]);
        shown.lines.push_back(shown.points.size() - before);
    }
    return shown;
}

Shown shown_points(const PolyData& data, std::size_t most_points) {
    const std::size_t every = std::max<std::size_t>(1, (data.points.size() + most_points - 1) / most_points);
    Shown shown;
    for (std::size_t k = 0; k < data.points.size(); k += every) shown.points.push_back(std::uint32_t(k));
    return shown;
}

Piece make_piece(const PolyData& data, const Shown& shown, const std::vector<FieldChoice>& fields, Joints joints) {
    Piece piece{.points = shown.points.size()};
    append_positions(piece, data, shown.points);
    for (const FieldChoice& choice : fields) append_field(piece, data, shown.points, choice);
    if (joints == Joints::left_out) return piece;
    piece.triangles = shown.triangles.size();
    piece.lines = shown.lines.size();
    for (const auto& triangle : shown.triangles)
        for (const std::uint32_t corner : triangle) piece.words.push_back(std::uint16_t(corner));
    for (const std::size_t length : shown.lines) piece.words.push_back(std::uint16_t(length));
    return piece;
}

PageData make_page_data(const RunResults& results) {
    PageData page;
    Json model{{"name", results.name}, {"flows", Json::array()}, {"bodies", Json::array()}, {"files", Json::array()}};
    for (const FlowPart& flow : results.flows) {
        Json part = flow_model(page, flow, results.part(flow));
        for (const TextFile& table : flow.tables) {
            const std::string id = fmt::format("data-{}", page.blobs.size());
            page.blobs.push_back({id, base64(deflated(table.text))});
            model["files"].push_back({{"name", table.name}, {"data", id}});
        }
        part["outlets"] = outlet_names(results.part(flow));
        part["pullback"] = flow.pullback ? Json(flow.prefix + "pullback.csv") : Json(nullptr);
        model["flows"].push_back(std::move(part));
    }
    for (const DeployedBody& body : results.bodies) model["bodies"].push_back(body_model(page, body));
    const FlowPart* first = results.flows.empty() ? nullptr : &results.flows.front();
    model["outlets"] = first ? Json(outlet_names(results.part(*first))) : Json::array();
    const std::optional<std::size_t> worst = first ? worst_lesion(results.part(*first)) : std::nullopt;
    model["stent"] = stent_model(*results.summary);
    model["worst_lesion"] = worst ? Json(*worst) : Json(nullptr);
    const PolyData* seen = first && first->wall     ? &*first->wall
                           : results.bodies.empty() ? nullptr
                                                    : &results.bodies.front().frames.front();
    model["space"] = seen ? seen->space : "";
    const View view = seen ? broad_view(seen->points) : View{};
    for (const auto& [name, axis] : {std::pair{"right", view.right}, {"up", view.up}, {"toward", view.toward}})
        model["view"][name] = {axis.x, axis.y, axis.z};
    model["colours"] = colour_table();
    page.model = model.dump(-1, ' ', false, Json::error_handler_t::replace);
    return page;
}

}   // namespace patency
