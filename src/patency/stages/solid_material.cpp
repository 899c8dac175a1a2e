// SPDX-License-Identifier: Apache-2.0
#include "patency/stages/solid_material.h"

#include <cmath>
#include <vector>

#include "patency/base/errors.h"
#include "patency/base/text.h"

namespace patency {

namespace {

using Choice = deck::SolidMaterialChoice;
using deck::SolidLawName;

/// Elasticity and linear hardening through the true stress where a test piece necks: ultimate stress times (1 + elongation)
/// at ln(1 + elongation).
Choice metal(double density, double young, double poisson, double yield, double ultimate, double elongation) {
    Choice c;
    c.law = SolidLawName::j2_plastic;
    c.density = density, c.young = young, c.poisson = poisson, c.yield_stress = yield;
    c.hardening = (ultimate * (1 + elongation) - yield) / std::log1p(elongation);
    return c;
}

Choice rubber_like(double density, double young, double poisson) {
    Choice c;
    c.law = SolidLawName::neo_hookean;
    c.density = density, c.young = young, c.poisson = poisson;
    return c;
}

Choice copper_bar() {
    Choice c;
    c.law = SolidLawName::j2_plastic;
    c.density = 8930, c.young = 117e9, c.poisson = 0.35, c.yield_stress = 400e6, c.hardening = 100e6;
    return c;
}

/// What gives way at its strength without hardening. `extensibility`: the stretch at which a strip broke, of which the secant gives E.
Choice tissue_that_gives_way(double density, double poisson, double strength, double extensibility) {
    Choice c;
    c.law = SolidLawName::j2_plastic;
    c.density = density, c.young = strength / std::log(extensibility), c.poisson = poisson, c.yield_stress = strength;
    return c;
}

/// Numbers of a choice that are wanted, each at most once.
class Numbers {
public:
    explicit Numbers(std::string path) : path_(std::move(path)) {}

    double needed(const std::optional<double>& value, std::string_view key, std::string_view law) const {
        if (value) return *value;
        throw DeckError(path_ + "." + std::string(key) + " is missing: " + std::string(law) + " needs it");
    }
    ElasticModuli moduli(const Choice& c) const {
        try {
            return elastic_moduli({c.young, c.poisson, c.shear, c.bulk});
        } catch (const DeckError& error) {
            throw DeckError(path_ + ": " + error.what());
        }
    }

private:
    std::string path_;
};

SolidLaw make_law(const Choice& c, const Numbers& numbers) {
    const std::string_view law = deck::words(*c.law)[std::size_t(*c.law)];
    const auto needed = [&](const std::optional<double>& value, std::string_view key) {
        return numbers.needed(value, key, law);
    };
    switch (*c.law) {
        case SolidLawName::neo_hookean: return NeoHookean::from(numbers.moduli(c));
        case SolidLawName::st_venant_kirchhoff: return StVenantKirchhoff::from(numbers.moduli(c));
        case SolidLawName::mooney_rivlin:
            return MooneyRivlin{needed(c.c10, "c10"), c.c01.value_or(0), needed(c.bulk, "bulk")};
        case SolidLawName::yeoh:
            return Yeoh{needed(c.c1, "c1"), c.c2.value_or(0), c.c3.value_or(0), needed(c.bulk, "bulk")};
        case SolidLawName::fibre_artery: {
            const ElasticModuli m = numbers.moduli(c);
            return FibreArtery{m.shear, needed(c.fibre_stiffness, "fibre_stiffness"),
                               needed(c.fibre_growth, "fibre_growth"), c.fibre_dispersion.value_or(0), m.bulk};
        }
        case SolidLawName::j2_plastic: break;
    }
    return J2Plastic{numbers.moduli(c),
                     {.yield = needed(c.yield_stress, "yield_stress"),
                      .slope = c.hardening.value_or(0),
                      .saturation = c.saturation_stress.value_or(0),
                      .rate = c.saturation_rate.value_or(0)}};
}

/// What stands in `over` goes over `under`; moduli only as a pair, so that two stay two.
Choice merged(const Choice& under, const Choice& over) {
    Choice c = under;
    const auto take = [](std::optional<double>& to, const std::optional<double>& from) {
        if (from) to = from;
    };
    if (over.young || over.poisson || over.shear || over.bulk)
        c.young = over.young, c.poisson = over.poisson, c.shear = over.shear, c.bulk = over.bulk;
    take(c.density, over.density);
    take(c.c10, over.c10), take(c.c01, over.c01), take(c.c1, over.c1), take(c.c2, over.c2), take(c.c3, over.c3);
    take(c.fibre_stiffness, over.fibre_stiffness), take(c.fibre_growth, over.fibre_growth);
    take(c.fibre_dispersion, over.fibre_dispersion), take(c.fibre_angle, over.fibre_angle);
    take(c.yield_stress, over.yield_stress), take(c.hardening, over.hardening);
    take(c.saturation_stress, over.saturation_stress), take(c.saturation_rate, over.saturation_rate);
    return c;
}

}   // namespace

std::span<const TableMaterial> material_table() {
    static const std::vector<TableMaterial> table = {
        {"coronary_wall", "coronary artery as one elastic layer",
         "arXiv 2511.08745, table III: E and nu, from which G and K follow", rubber_like(1080, 1e6, 0.45)},
        {"calcified_plaque", "stiff plaque, elastic",
         "Ansys Mechanical APDL Technology Showcase, chapter 25 (a stent in an occluded artery): E 2.19 MPa, nu 0.49; "
         "density as the wall's",
         rubber_like(1080, 2.19e6, 0.49)},
        {"fibrous_plaque",
         "plaque that gives way where its strength ends and stays where it is pushed: E 0.956 MPa, yield 158 kPa, no "
         "hardening",
         "Teng et al. 2015, J. Biomech. 48, 3859: fibrous caps bore 158.3 kPa and a stretch of 1.18 (medians); nu and "
         "density as the wall's",
         tissue_that_gives_way(1080, 0.45, 158.3e3, 1.18)},
        {"316L", "stainless steel, annealed",
         "ASTM F138, least values: yield 172 MPa, ultimate 485 MPa, elongation 40 %",
         metal(8000, 193e9, 0.3, 172e6, 485e6, 0.40)},
        {"L605", "cobalt-chromium alloy, annealed",
         "ASTM F90, least values: yield 310 MPa, ultimate 860 MPa, elongation 30 %",
         metal(9130, 243e9, 0.3, 310e6, 860e6, 0.30)},
        {"MP35N", "cobalt-nickel alloy, annealed",
         "ASTM F562, least values: yield 241 MPa, ultimate 793 MPa, elongation 50 %",
         metal(8430, 233e9, 0.3, 241e6, 793e6, 0.50)},
        {"PtCr", "platinum-chromium steel",
         "O'Brien et al. 2010, Biomaterials 31, 3755: yield 480 MPa, ultimate 834 MPa, elongation 45 %, modulus 203 "
         "GPa",
         metal(9900, 203e9, 0.3, 480e6, 834e6, 0.45)},
        {"copper_bar", "copper of the Taylor bar of the literature",
         "Camacho & Ortiz 1997, Comput. Methods Appl. Mech. Eng. 142, 269", copper_bar()},
    };
    return table;
}

SolidMaterial make_solid_material(const Choice& choice, const std::string& path) {
    Choice c = choice;
    if (choice.name) {
        std::vector<std::string> names;
        const TableMaterial* found = nullptr;
        for (const TableMaterial& m : material_table()) {
            names.emplace_back(m.name);
            if (m.name == *choice.name) found = &m;
        }
        if (!found) {
            const std::string near = nearest_name(*choice.name, names);
            throw DeckError(path + ".name: there is no material " + double_quoted(shortened(*choice.name)) +
                            " in the table, which has " + join(names, ", ", " and ") +
                            (near.empty() ? "" : ". Did you mean " + double_quoted(near) + "?"));
        }
        c = merged(found->numbers, choice);
    }
    const Numbers numbers(path);
    return {numbers.needed(c.density, "density", "every material"), make_law(c, numbers)};
}

}   // namespace patency
