// SPDX-License-Identifier: Apache-2.0
#include "patency/io/hdf5_image.h"

#include <hdf5.h>

#include <algorithm>
#include <type_traits>

#include "patency/base/errors.h"

namespace patency::hdf5 {
namespace {

static_assert(std::is_same_v<hid_t, std::int64_t> && std::is_same_v<herr_t, int> && std::is_same_v<hsize_t, Extent>);

constexpr std::size_t growth = std::size_t(16) << 20;   // bytes by which a file in memory grows

void expect(bool is_well, std::string_view what) {
    if (!is_well) throw CheckpointError("HDF5 could not " + std::string(what) + ".");
}

/// The library would print its errors; the wrapper throws them.
void be_quiet() { H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); }

Id memory_access() {
    be_quiet();
    Id access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "prepare a file");
    expect(H5Pset_fapl_core(access, growth, false) >= 0, "keep a file in memory");
    return access;
}

/// On disk little-endian, as in the memory of every machine the program runs on.
Id make_type(const Form& form) {
    const hid_t type = form.kind == Kind::float64 ? H5T_IEEE_F64LE
                       : form.kind == Kind::int32 ? H5T_STD_I32LE
                       : form.kind == Kind::int64 ? H5T_STD_I64LE
                       : form.kind == Kind::byte  ? H5T_STD_U8LE
                                                  : H5T_C_S1;
    Id copy(H5Tcopy(type), H5Tclose, "copy a type");
    if (form.kind == Kind::text) {
        // A text of no letters has size 1 and no elements.
        expect(H5Tset_size(copy, std::max<Extent>(form.shape[0], 1)) >= 0 &&
                   H5Tset_strpad(copy, H5T_STR_NULLPAD) >= 0 && H5Tset_cset(copy, H5T_CSET_UTF8) >= 0,
               "make a type of text");
    }
    return copy;
}

Id make_space(const Form& form) {
    if (form.kind == Kind::text)
        return {H5Screate(form.shape[0] > 0 ? H5S_SCALAR : H5S_NULL), H5Sclose, "make a space"};
    if (form.shape.empty()) return {H5Screate(H5S_SCALAR), H5Sclose, "make a space"};
    return {H5Screate_simple(int(form.shape.size()), form.shape.data(), nullptr), H5Sclose, "make a space"};
}

Kind kind_of(hid_t type) {
    if (H5Tget_class(type) == H5T_STRING) return Kind::text;
    if (H5Tequal(type, H5T_IEEE_F64LE) > 0) return Kind::float64;
    if (H5Tequal(type, H5T_STD_I32LE) > 0) return Kind::int32;
    if (H5Tequal(type, H5T_STD_I64LE) > 0) return Kind::int64;
    if (H5Tequal(type, H5T_STD_U8LE) > 0) return Kind::byte;
    throw CheckpointError("a dataset has a type that checkpoints do not have.");
}

Form form_from(hid_t type, hid_t space) {
    Form form{kind_of(type), {}};
    if (form.kind == Kind::text) {
        form.shape = {H5Sget_simple_extent_type(space) == H5S_NULL ? 0 : H5Tget_size(type)};
    } else {
        const int rank = H5Sget_simple_extent_ndims(space);
        expect(rank >= 0, "read a shape");
        form.shape.resize(std::size_t(rank));
        H5Sget_simple_extent_dims(space, form.shape.data(), nullptr);
    }
    return form;
}

Id open_dataset(const Id& file, const std::string& name) {
    return {H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose, "open " + name};
}

Id with_groups_on_the_way() {
    Id links(H5Pcreate(H5P_LINK_CREATE), H5Pclose, "prepare a link");
    expect(H5Pset_create_intermediate_group(links, 1) >= 0, "prepare groups");
    return links;
}

}   // namespace

Id::Id(std::int64_t id, Close close, std::string_view what) : id_(id), close_(close) { expect(id >= 0, what); }

std::size_t Form::size() const {
    std::size_t bytes = kind == Kind::float64 || kind == Kind::int64 ? 8 : kind == Kind::int32 ? 4 : 1;
    for (Extent extent : shape) bytes *= extent;
    return bytes;
}

Id make_image() {
    return {H5Fcreate("checkpoint", H5F_ACC_TRUNC, H5P_DEFAULT, memory_access()), H5Fclose, "make a file in memory"};
}

Id open_image(std::string_view bytes) {
    const Id access = memory_access();
    // The library copies the bytes; its signature only lacks a const.
    expect(H5Pset_file_image(access, const_cast<char*>(bytes.data()), bytes.size()) >= 0, "take over a file");
    return {H5Fopen("checkpoint", H5F_ACC_RDONLY, access), H5Fclose, "open a file in memory"};
}

std::string image_of(const Id& file) {
    expect(H5Fflush(file, H5F_SCOPE_GLOBAL) >= 0, "flush a file in memory");
    const ssize_t size = H5Fget_file_image(file, nullptr, 0);
    expect(size >= 0, "measure a file in memory");
    std::string bytes(std::size_t(size), '\0');
    expect(H5Fget_file_image(file, bytes.data(), bytes.size()) == size, "copy a file in memory");
    return bytes;
}

void write_dataset(const Id& file, const std::string& name, const Form& form, std::span<const std::byte> bytes) {
    const Id creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, "prepare " + name);
    expect(H5Pset_obj_track_times(creation, false) >= 0, "leave out the date");   // same state, same bytes
    const Id type = make_type(form), space = make_space(form), links = with_groups_on_the_way();
    const Id dataset(H5Dcreate2(file, name.c_str(), type, space, links, creation, H5P_DEFAULT), H5Dclose,
                     "make " + name);
    if (!bytes.empty())
        expect(H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes.data()) >= 0, "write " + name);
}

void write_text_attribute(const Id& file, const std::string& dataset, const std::string& name,
                          const std::string& text) {
    const Id owner = open_dataset(file, dataset);
    const Form form{Kind::text, {text.size()}};
    const Id type = make_type(form), space = make_space(form);
    const Id attribute(H5Acreate2(owner, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose,
                       "make " + name);
    if (!text.empty()) expect(H5Awrite(attribute, type, text.data()) >= 0, "write " + name);
}

void make_group(const Id& file, const std::string& name) {
    const Id links = with_groups_on_the_way();
    const Id group(H5Gcreate2(file, name.c_str(), links, H5P_DEFAULT, H5P_DEFAULT), H5Gclose, "make " + name);
}

bool contains(const Id& file, const std::string& name) {
    // H5Lexists asks for every group on the way separately.
    for (std::size_t at = name.find('/'); at != name.npos; at = name.find('/', at + 1))
        if (at > 0 && H5Lexists(file, name.substr(0, at).c_str(), H5P_DEFAULT) <= 0) return false;
    return H5Lexists(file, name.c_str(), H5P_DEFAULT) > 0;
}

Form form_of(const Id& file, const std::string& name) {
    const Id dataset = open_dataset(file, name);
    const Id type(H5Dget_type(dataset), H5Tclose, "read a type"),
        space(H5Dget_space(dataset), H5Sclose, "read a shape");
    return form_from(type, space);
}

void read_dataset(const Id& file, const std::string& name, std::span<std::byte> bytes) {
    if (bytes.empty()) return;
    const Id dataset = open_dataset(file, name);
    const Id type(H5Dget_type(dataset), H5Tclose, "read a type");
    expect(H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes.data()) >= 0, "read " + name);
}

std::string read_text_attribute(const Id& file, const std::string& dataset, const std::string& name) {
    const Id owner = open_dataset(file, dataset);
    const Id attribute(H5Aopen(owner, name.c_str(), H5P_DEFAULT), H5Aclose, "open " + name);
    const Id type(H5Aget_type(attribute), H5Tclose, "read a type"),
        space(H5Aget_space(attribute), H5Sclose, "read a shape");
    const Form form = form_from(type, space);
    expect(form.kind == Kind::text, "read text from " + name);
    std::string text(form.size(), '\0');
    if (!text.empty()) expect(H5Aread(attribute, type, text.data()) >= 0, "read " + name);
    return text;
}

std::vector<std::string> names_in(const Id& file, const std::string& name) {
    const Id group(H5Gopen2(file, name.c_str(), H5P_DEFAULT), H5Gclose, "open " + name);
    H5G_info_t info;
    expect(H5Gget_info(group, &info) >= 0, "look into " + name);
    std::vector<std::string> names;
    for (hsize_t i = 0; i < info.nlinks; ++i) {
        const ssize_t size = H5Lget_name_by_idx(group, ".", H5_INDEX_NAME, H5_ITER_INC, i, nullptr, 0, H5P_DEFAULT);
        expect(size >= 0, "look into " + name);
        std::string entry(std::size_t(size) + 1, '\0');
        H5Lget_name_by_idx(group, ".", H5_INDEX_NAME, H5_ITER_INC, i, entry.data(), entry.size(), H5P_DEFAULT);
        entry.pop_back();
        names.push_back(std::move(entry));
    }
    return names;
}

}   // namespace patency::hdf5
