// SPDX-License-Identifier: Apache-2.0
#include "patency/schemes/cell_matrix.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <span>

#include "patency/base/parallel.h"

namespace patency {

double product(const CellVectors& a, const CellVectors& b) {
    return sum_of(a.size(), [&](std::size_t i) {
        const CellVector c = a[i] * b[i];
        return (double(c[0]) + double(c[1])) + (double(c[2]) + double(c[3]));
    });
}

namespace {

constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
constexpr std::size_t fewest_rows = 60;   // of the coarsest level
constexpr int coarsest_sweeps = 10;
constexpr int rounds = 3;   // of pairing per level: eight cells become one

struct Graph {
    std::vector<std::uint32_t> start, column;
    std::vector<float> weight;
    std::size_t size() const { return start.size() - 1; }
};

/// Each vertex with its unpaired neighbour of the largest weight. Returns the new vertex of each.
std::vector<std::uint32_t> find_pairs(const Graph& graph, std::uint32_t& count) {
    std::vector<std::uint32_t> pair(graph.size(), none);
    count = 0;
    for (std::uint32_t i = 0; i < graph.size(); ++i) {
        if (pair[i] != none) continue;
        std::uint32_t best = none;
        float largest = 0;
        for (std::uint32_t k = graph.start[i]; k < graph.start[i + 1]; ++k)
            if (const std::uint32_t j = graph.column[k]; pair[j] == none && j != i && graph.weight[k] > largest)
                best = j, largest = graph.weight[k];
        pair[i] = count;
        if (best != none) pair[best] = count;
        ++count;
    }
    return pair;
}

/// Members of each of `count` groups.
void list_members(const std::vector<std::uint32_t>& group, std::size_t count, std::vector<std::uint32_t>& start,
                  std::vector<std::uint32_t>& member) {
    start.assign(count + 1, 0);
    for (const std::uint32_t g : group) ++start[g + 1];
    for (std::size_t g = 0; g < count; ++g) start[g + 1] += start[g];
    member.resize(group.size());
    std::vector<std::uint32_t> next(start.begin(), start.end() - 1);
    for (std::uint32_t i = 0; i < group.size(); ++i) member[next[group[i]]++] = i;
}

Graph joined_graph(const Graph& fine, const std::vector<std::uint32_t>& group, std::size_t count) {
    std::vector<std::uint32_t> start, member, place(count, none), columns;
    list_members(group, count, start, member);
    Graph coarse;
    coarse.start.assign(1, 0);
    std::vector<float> weights(count, 0);
    for (std::uint32_t g = 0; g < count; ++g) {
        columns.clear();
        for (std::uint32_t k = start[g]; k < start[g + 1]; ++k)
            for (std::uint32_t e = fine.start[member[k]]; e < fine.start[member[k] + 1]; ++e) {
                const std::uint32_t to = group[fine.column[e]];
                if (to == g) continue;
                if (place[to] != g) place[to] = g, weights[to] = 0, columns.push_back(to);
                weights[to] += fine.weight[e];
            }
        std::sort(columns.begin(), columns.end());
        for (const std::uint32_t to : columns) coarse.column.push_back(to), coarse.weight.push_back(weights[to]);
        coarse.start.push_back(std::uint32_t(coarse.column.size()));
    }
    return coarse;
}

/// Greedy colours of the runs of rows.
void colour_runs(const Graph& graph, CellLevel& level) {
    constexpr std::size_t length = CellLevel::run_length;
    const std::size_t runs = (graph.size() + length - 1) / length;
    std::vector<std::vector<std::uint32_t>> touches(runs);
    for (std::uint32_t i = 0; i < graph.size(); ++i)
        for (std::uint32_t k = graph.start[i]; k < graph.start[i + 1]; ++k) {
            const auto a = std::uint32_t(i / length), b = std::uint32_t(graph.column[k] / length);
            if (a != b && (touches[a].empty() || touches[a].back() != b)) touches[a].push_back(b);
        }
    level.colour.assign(runs, std::uint32_t(runs));
    for (std::uint32_t a = 0; a < runs; ++a) {
        std::vector<char> is_taken(level.colours.size() + 1, 0);
        for (const std::uint32_t b : touches[a])
            if (level.colour[b] < is_taken.size()) is_taken[level.colour[b]] = 1;
        level.colour[a] = std::uint32_t(std::find(is_taken.begin(), is_taken.end(), 0) - is_taken.begin());
        if (level.colour[a] == level.colours.size()) level.colours.emplace_back();
        level.colours[level.colour[a]].push_back(a);
    }
}

CellLevel make_level(const Graph& graph) {
    CellLevel level;
    const std::size_t rows = graph.size();
    level.diagonal.resize(rows);
    for (CellVectors* vectors : {&level.x, &level.b, &level.r, &level.change}) vectors->resize(rows);
    colour_runs(graph, level);
    level.earlier.start.assign(1, 0), level.later.start.assign(1, 0);
    for (std::uint32_t i = 0; i < rows; ++i) {
        for (std::uint32_t k = graph.start[i]; k < graph.start[i + 1]; ++k) {
            const std::uint32_t j = graph.column[k];
            (level.is_earlier(j, i) ? level.earlier : level.later).entry.push_back({{}, 0, j});
        }
        for (CellTriangle* part : {&level.earlier, &level.later})
            part->start.push_back(std::uint32_t(part->entry.size()));
    }
    return level;
}

/// The place of a column in a row: those of `later` are counted behind those of `earlier`.
std::size_t place_in_row(const CellLevel& level, std::size_t i, std::uint32_t column) {
    const auto place = [column](std::span<const CellMatrixEntry> row) {
        const auto is_left = [](const CellMatrixEntry& e, std::uint32_t to) { return e.column < to; };
        return std::size_t(std::lower_bound(row.begin(), row.end(), column, is_left) - row.begin());
    };
    const auto earlier = level.earlier.row(i);
    return level.is_earlier(column, i) ? place(earlier) : earlier.size() + place(level.later.row(i));
}

constexpr CellVector broadcast(float s) { return CellVector{s, s, s, s}; }

CellVector coupling_of(const CellMatrixEntry& entry) {
    CellVector a;
    std::memcpy(&a, entry.coupling, sizeof a);
    return a;
}

struct EntrySum {
    CellVector coupling{};
    float transport = 0;
};

/// What neighbours add to a row. A sweep back goes through memory backwards, or what it needs next would not be fetched ahead.
struct RowSum {
    CellVector mass{}, momentum{};

    void add(const CellMatrixEntry& e, const CellVectors& x) {
        const CellVector y = x[e.column], a = coupling_of(e);
        mass += a * y;
        momentum += broadcast(e.transport) * y + a * broadcast(y[0]);
    }
    RowSum& add(std::span<const CellMatrixEntry> row, const CellVectors& x) {
        for (const CellMatrixEntry& e : row) add(e, x);
        return *this;
    }
    RowSum& add_back(std::span<const CellMatrixEntry> row, const CellVectors& x) {
        for (std::size_t k = row.size(); k-- > 0;) add(row[k], x);
        return *this;
    }
    CellVector value() const {
        CellVector sum = momentum;
        sum[0] = (mass[0] + mass[1]) + (mass[2] + mass[3]);
        return sum;
    }
};

inline CellVector row_times(const CellLevel& level, const CellVectors& x, std::size_t i) {
    const CellMatrixRow& d = level.diagonal[i];
    const CellVector y = x[i], div = d.divergence * y;
    CellVector sum = broadcast(d.m_diagonal) * y + d.gradient * broadcast(y[0]);
    sum[0] = d.p_diagonal * y[0] + (div[1] + div[2] + div[3]);
    return sum + RowSum().add(level.earlier.row(i), x).add(level.later.row(i), x).value();
}

void prepare(CellMatrixRow& d) {
    const CellVector square = d.divergence * d.gradient;
    d.per_momentum = 1 / d.m_diagonal;
    d.per_pressure = 1 / (d.p_diagonal - (square[1] + square[2] + square[3]) * d.per_momentum);
}

/// Solves row i, whose neighbours add so much, for its own four unknowns.
inline void relax_row(CellLevel& level, std::size_t i, const CellVector& of_neighbours) {
    const CellMatrixRow& d = level.diagonal[i];
    const CellVector right = level.b[i] - of_neighbours, through = d.divergence * right;
    const float p = (right[0] - (through[1] + through[2] + through[3]) * d.per_momentum) * d.per_pressure;
    CellVector x = broadcast(d.per_momentum) * (right - d.gradient * broadcast(p));
    x[0] = p;
    level.x[i] = x;
}

template <class Rows>
void for_each_run(const CellLevel& level, const std::vector<std::uint32_t>& runs, Rows rows) {
    const auto run = [&](std::size_t k) {
        const std::size_t begin = runs[k] * CellLevel::run_length;
        rows(begin, std::min(level.size(), begin + CellLevel::run_length));
    };
    if (runs.size() == 1)
        run(0);
    else
        for_each_task(runs.size(), run);
}

/// What was there of x counts as zero, so only neighbours that the sweep has come to before add anything.
void sweep_there_from_zero(CellLevel& level) {
    for (const auto& runs : level.colours)
        for_each_run(level, runs, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
                relax_row(level, i, RowSum().add(level.earlier.row(i), level.x).value());
        });
}

/// And all that this leaves is what the neighbours add that it came to afterwards.
void compute_residual_of_sweep(CellLevel& level) {
    for_each_index(level.size(),
                   [&](std::size_t i) { level.r[i] = -RowSum().add(level.later.row(i), level.x).value(); });
}

void sweep_there(CellLevel& level) {
    for (const auto& runs : level.colours)
        for_each_run(level, runs, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
                relax_row(level, i,
                          RowSum().add(level.later.row(i), level.x).add(level.earlier.row(i), level.x).value());
        });
}

void sweep_back(CellLevel& level) {
    for (auto runs = level.colours.rbegin(); runs != level.colours.rend(); ++runs)
        for_each_run(level, *runs, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = end; i-- > begin;) {
                const CellVector before = level.x[i];
                relax_row(
                    level, i,
                    RowSum().add_back(level.earlier.row(i), level.x).add_back(level.later.row(i), level.x).value());
                level.change[i] = level.x[i] - before;
            }
        });
}

/// The matrix times x after a sweep back: it left every row solved but for what the neighbours that it came to later have changed.
void compute_product_of_sweep(const CellLevel& level, CellVectors& product) {
    for_each_index(level.size(), [&](std::size_t i) {
        product[i] = level.b[i] + RowSum().add(level.earlier.row(i), level.change).value();
    });
}

}   // namespace

CellMatrix::CellMatrix(const CellMesh& mesh) {
    Graph graph;
    graph.start = mesh.row_start;
    for (const CellNeighbour& n : mesh.row) {
        graph.column.push_back(n.cell);
        graph.weight.push_back(float(mesh.faces[n.face].conductance));
    }
    levels_.push_back(make_level(graph));
    while (levels_.back().size() > fewest_rows) {
        CellLevel& fine = levels_.back();
        fine.parent.resize(fine.size());
        for (std::uint32_t i = 0; i < fine.size(); ++i) fine.parent[i] = i;
        std::uint32_t count = std::uint32_t(fine.size());
        for (int round = 0; round < rounds; ++round) {
            const std::vector<std::uint32_t> pair = find_pairs(graph, count);
            graph = joined_graph(graph, pair, count);
            for (std::uint32_t& p : fine.parent) p = pair[p];
        }
        if (count > 0.8 * double(fine.size())) break;   // nothing hangs together any more
        CellLevel coarse = make_level(graph);
        coarse.first.resize(count), coarse.answer.resize(count);
        list_members(fine.parent, count, coarse.child_start, coarse.child);
        for (CellTriangle* part : {&fine.earlier, &fine.later}) {
            part->parent.resize(part->entry.size());
            for_each_index(fine.size(), [&](std::size_t i) {
                const std::uint32_t p = fine.parent[i];
                for (std::uint32_t k = part->start[i]; k < part->start[i + 1]; ++k) {
                    const std::uint32_t q = fine.parent[part->entry[k].column];
                    part->parent[k] = q == p ? CellTriangle::inside : std::uint16_t(place_in_row(coarse, p, q));
                }
            });
        }
        levels_.push_back(std::move(coarse));
    }
}

void CellMatrix::make_coarse() {
    for (std::size_t n = 0; n + 1 < levels_.size(); ++n) {
        const CellLevel& fine = levels_[n];
        CellLevel& coarse = levels_[n + 1];
        for_each_block(coarse.size(), [&](std::size_t begin, std::size_t end) {
            std::vector<EntrySum> sums;   // a coarse row
            for (std::size_t p = begin; p < end; ++p) {
                CellMatrixRow diagonal;
                sums.assign(coarse.earlier.row(p).size() + coarse.later.row(p).size(), {});
                for (std::uint32_t c = coarse.child_start[p]; c < coarse.child_start[p + 1]; ++c) {
                    const std::uint32_t i = coarse.child[c];
                    const CellMatrixRow& own = fine.diagonal[i];
                    diagonal.p_diagonal += own.p_diagonal, diagonal.m_diagonal += own.m_diagonal;
                    diagonal.gradient += own.gradient, diagonal.divergence += own.divergence;
                    for (const CellTriangle* part : {&fine.earlier, &fine.later})
                        for (std::uint32_t k = part->start[i]; k < part->start[i + 1]; ++k) {
                            const CellVector a = coupling_of(part->entry[k]);
                            if (const auto to = part->parent[k]; to != CellTriangle::inside) {
                                sums[to].coupling += a, sums[to].transport += part->entry[k].transport;
                            } else {
                                const CellVector area{0, a[1], a[2], a[3]};
                                diagonal.p_diagonal += a[0], diagonal.m_diagonal += part->entry[k].transport;
                                diagonal.gradient += area, diagonal.divergence += area;
                            }
                        }
                }
                coarse.diagonal[p] = diagonal;
                const EntrySum* sum = sums.data();
                for (CellTriangle* part : {&coarse.earlier, &coarse.later})
                    for (std::uint32_t k = part->start[p]; k < part->start[p + 1]; ++k, ++sum) {
                        std::memcpy(part->entry[k].coupling, &sum->coupling, sizeof sum->coupling);
                        part->entry[k].transport = sum->transport;
                    }
            }
        });
    }
    for (CellLevel& level : levels_) for_each_index(level.size(), [&](std::size_t i) { prepare(level.diagonal[i]); });
}

void CellMatrix::multiply(const CellVectors& x, CellVectors& y) const {
    const CellLevel& level = levels_.front();
    for_each_index(level.size(), [&](std::size_t i) { y[i] = row_times(level, x, i); });
}

void CellMatrix::precondition(const CellVectors& b, CellVectors& x, CellVectors& product) {
    CellLevel& level = levels_.front();
    level.b = b;
    cycle(0);
    x = level.x;
    compute_product_of_sweep(level, product);
}

void CellMatrix::cycle(std::size_t n) {
    CellLevel& level = levels_[n];
    sweep_there_from_zero(level);
    if (n + 1 == levels_.size()) {
        for (int k = 1; k < coarsest_sweeps; ++k) sweep_back(level), sweep_there(level);
        sweep_back(level);
        return;
    }
    compute_residual_of_sweep(level);
    CellLevel& coarse = levels_[n + 1];
    for_each_index(coarse.size(), [&](std::size_t p) {
        CellVector sum{};
        for (std::uint32_t c = coarse.child_start[p]; c < coarse.child_start[p + 1]; ++c)
            sum += level.r[coarse.child[c]];
        coarse.b[p] = sum;
    });
    solve_coarse(n + 1);
    for_each_index(level.size(), [&](std::size_t i) { level.x[i] += coarse.x[level.parent[i]]; });
    sweep_back(level);
}

/// x about the inverse times b by one or two cycles, each as long as leaves least: joined cells are too stiff by a factor that grows from
/// level to level, and one cycle alone would leave more of long waves the finer the cells are.          THEORY.md (18.13)
void CellMatrix::solve_coarse(std::size_t n) {
    constexpr double enough = 0.25;   // of the right side, or a second cycle follows
    CellLevel& level = levels_[n];
    cycle(n);
    if (n + 1 == levels_.size()) return;   // swept until it is solved
    CellVectors &first = level.first, &answer = level.answer;
    compute_product_of_sweep(level, answer);
    first.swap(level.x);
    const double square = product(answer, answer), before = product(level.b, level.b);
    if (!(square > 0)) return level.x.swap(first);
    const double share = product(answer, level.b) / square;
    for_each_index(level.size(), [&](std::size_t i) { level.b[i] -= broadcast(float(share)) * answer[i]; });
    const double left = product(level.b, level.b);
    if (!(left > enough * enough * before)) {
        for_each_index(level.size(), [&](std::size_t i) { level.x[i] = broadcast(float(share)) * first[i]; });
        return;
    }
    cycle(n);
    CellVectors& second_answer = level.r;
    compute_product_of_sweep(level, second_answer);
    // The second one orthogonal to the first.
    const double along = product(second_answer, answer) / square;
    const double rest = product(second_answer, second_answer) - along * along * square;
    const double second_share =
        rest > 1e-12 * square ? product(second_answer, level.b) / rest : 0;   // b is orthogonal to the first
    for_each_index(level.size(), [&](std::size_t i) {
        level.x[i] =
            broadcast(float(share - second_share * along)) * first[i] + broadcast(float(second_share)) * level.x[i];
    });
}

}   // namespace patency
