// Sound records that another program has changed through HDF5 and sealed again: every departure from the grammar must be named.
#include <catch2/catch.hpp>
#include <functional>

#include "common/base/atomic_file.hpp"
#include "common/record/check.hpp"
#include "common/record/grammar.hpp"
#include "common/record/hdf5.hpp"
#include "common/record/seal.hpp"
#include "common/record/writer.hpp"
#include "tests/record/sample_fdem.hpp"
#include "tests/record/sample_record.hpp"
#include "tests/record/temporary_folder.hpp"

using namespace fracfarm;

namespace {

// What the validator says about the grammar after `change` was at the open file; empty where it says nothing.
std::string said_after(const std::function<void(hid_t)>& change, const Record& record = sample::record()) {
  const test::TemporaryFolder folder;
  const auto path = folder.path() / "record.h5";
  const std::string sound = record_bytes(record).value();
  REQUIRE(write_atomically(path, sound.substr(0, sound.size() - seal_size)));
  {
    const h5::Silence silence;
    const h5::Handle file = h5::file(H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT));
    REQUIRE(file);
    change(file);
  }
  std::string bytes = read_file(path, 1 << 30).value();
  bytes += seal_of(bytes);
  const CheckedRecord checked = check_record_bytes(bytes);
  REQUIRE(checked.checks.at(0).passed);  // the seal fits
  return checked.checks.at(1).passed ? "" : checked.checks.at(1).detail;
}

struct Shape {
  std::vector<hsize_t> dims, chunk;  // no chunk: contiguous
  bool checksum = true;
  hid_t type = H5T_IEEE_F32LE;
};

// Puts an empty-handed dataset in the place of another.
void replace(hid_t file, const char* path, const Shape& shape) {
  H5Ldelete(file, path, H5P_DEFAULT);
  const h5::Handle space = h5::space(H5Screate_simple(static_cast<int>(shape.dims.size()), shape.dims.data(), nullptr));
  const h5::Handle layout = h5::properties(H5Pcreate(H5P_DATASET_CREATE));
  if (!shape.chunk.empty()) {
    H5Pset_chunk(layout, static_cast<int>(shape.chunk.size()), shape.chunk.data());
    H5Pset_shuffle(layout);
    H5Pset_deflate(layout, 3);
    if (shape.checksum) H5Pset_fletcher32(layout);
  }
  const h5::Handle made = h5::dataset(H5Dcreate2(file, path, shape.type, space, H5P_DEFAULT, layout, H5P_DEFAULT));
  REQUIRE(made);
}

void add_text(hid_t file, const char* object, const char* name, const std::string& text) {
  const h5::Handle holder = h5::object(H5Oopen(file, object, H5P_DEFAULT));
  H5Adelete(holder, name);
  const h5::Handle type = h5::type(H5Tcopy(H5T_C_S1));
  H5Tset_size(type, text.size());
  const h5::Handle space = h5::space(H5Screate(H5S_SCALAR));
  const h5::Handle made = h5::attribute(H5Acreate2(holder, name, type, space, H5P_DEFAULT, H5P_DEFAULT));
  REQUIRE(H5Awrite(made, type, text.c_str()) >= 0);
}

bool has(const std::string& text, const char* part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST_CASE("a record that was opened for writing and left alone is still of the grammar") {
  CHECK(said_after([](hid_t) {}).empty());
}

TEST_CASE("missing and unexpected objects are named") {
  CHECK(has(said_after([](hid_t f) { H5Ldelete(f, "/mask_initial", H5P_DEFAULT); }), "/mask_initial: missing"));
  CHECK(has(said_after([](hid_t f) { H5Ldelete(f, "/failure", H5P_DEFAULT); }), "/failure: missing"));
  CHECK(has(said_after([](hid_t f) { replace(f, "/extra", {{4}, {4}}); }), "/extra: not part of the grammar"));
  CHECK(has(said_after([](hid_t f) { replace(f, "/checks/extra", {{4}, {4}}); }), "/checks/extra: not part of the grammar"));
}

TEST_CASE("links that lead elsewhere are not followed") {
  CHECK(has(said_after([](hid_t f) { H5Lcreate_soft("/psi", f, "/series/soft", H5P_DEFAULT, H5P_DEFAULT); }), "/series/soft: not part"));
  CHECK(has(said_after([](hid_t f) { H5Lcreate_external("/etc/passwd", "/x", f, "/series/outside", H5P_DEFAULT, H5P_DEFAULT); }),
            "/series/outside"));
  CHECK_FALSE(said_after([](hid_t f) { H5Lcreate_hard(f, "/", f, "/series/circle", H5P_DEFAULT, H5P_DEFAULT); }).empty());
}

TEST_CASE("datasets of another type, rank, extent, chunk or filter are named") {
  CHECK(has(said_after([](hid_t f) { replace(f, "/psi_failure", {{12, 16}, {12, 16}, true, H5T_IEEE_F64LE}); }), "not of the type"));
  CHECK(has(said_after([](hid_t f) { replace(f, "/psi_failure", {{12}, {12}}); }), "dimensions"));
  CHECK(has(said_after([](hid_t f) { replace(f, "/psi_failure", {{12, 17}, {12, 17}}); }), "extent 1 is 17, it should be 16"));
  CHECK(has(said_after([](hid_t f) { replace(f, "/psi_failure", {{12, 16}, {6, 16}}); }), "chunks are 6 x 16, they should be 12 x 16"));
  CHECK(has(said_after([](hid_t f) { replace(f, "/psi_failure", {{12, 16}, {12, 16}, false}); }), "filters are not"));
  CHECK(has(said_after([](hid_t f) { replace(f, "/psi_failure", {{12, 16}, {}}); }), "no checksum"));
  CHECK(has(said_after([](hid_t f) { replace(f, "/psi_failure", {{12, 16}, {12, 16}}); }), "chunk 0 is missing"));
}

TEST_CASE("a dataset that claims more than its file can hold is refused before it is allocated") {
  CHECK(has(said_after([](hid_t f) { replace(f, "/time", {{1u << 30}, {65536}, true, H5T_IEEE_F64LE}); }), "limit"));
  CHECK(has(said_after([](hid_t f) {
              replace(f, "/time", {{100000000}, {65536}, true, H5T_IEEE_F64LE});
            }),
            "more than a file of this size can hold"));
}

TEST_CASE("attributes that are missing, foreign or changed are named") {
  CHECK(has(said_after([](hid_t f) { H5Adelete(f, "material"); }), "'material' is missing"));
  CHECK(has(said_after([](hid_t f) { add_text(f, "/", "comment", "mine"); }), "'comment' is not part of the grammar"));
  CHECK(has(said_after([](hid_t f) { add_text(f, "/psi", "comment", "mine"); }), "'comment' is not part of the grammar"));
  CHECK(has(said_after([](hid_t f) { add_text(f, "/psi", "units", "Pa"); }), "'units' is not '1'"));
  CHECK(has(said_after([](hid_t f) { add_text(f, "/", "verdict", "splendid"); }), "'verdict' has a value that is not allowed"));
  CHECK(has(said_after([](hid_t f) { add_text(f, "/", "licence", "none"); }), "'licence' differs"));
  CHECK(has(said_after([](hid_t f) { add_text(f, "/", "time_to_failure", "soon"); }), "not of its type"));
  CHECK(has(said_after([](hid_t f) { add_text(f, "/z", "NAME", "y"); }), "'NAME' is not 'z'"));
}

TEST_CASE("a record of the second schema is read: the phase field's layout is the same") {
  CHECK(said_after([](hid_t f) { add_text(f, "/", "fracfarm_schema", "fracfarm.record/2"); }).empty());
}

TEST_CASE("the method says which layout, and must have one") {
  CHECK(has(said_after([](hid_t f) { add_text(f, "/", "method", "alchemy"); }), "'method' is missing or 'alchemy'"));
  CHECK(has(said_after([](hid_t f) { H5Adelete(f, "method"); }), "'method' is missing"));
  CHECK(has(said_after([](hid_t f) { add_text(f, "/", "method", "fdem"); }), "/psi: not part of the grammar"));
  CHECK(has(said_after([](hid_t f) { add_text(f, "/", "method", "phase_field"); }, sample::fdem_record()), "/node: not part"));
}

TEST_CASE("a record of the first schema is read, and one that mixes the two is not") {
  const std::string rounding = "to the nearest float with 12 explicit mantissa bits, ties to even; 0 and 1 are exact";
  const auto round_as_first = [&](hid_t f) {
    for (const char* field : {"/psi", "/psi_initial", "/psi_failure"}) add_text(f, field, "rounding", rounding);
  };
  const auto call_first = [](hid_t f) { add_text(f, "/", "fracfarm_schema", "fracfarm.record/1"); };
  CHECK(said_after([&](hid_t f) { round_as_first(f), call_first(f); }).empty());
  CHECK(has(said_after(call_first), "'rounding' is not"));
  CHECK(has(said_after(round_as_first), "'rounding' is not"));
  CHECK(has(said_after([](hid_t f) { add_text(f, "/", "fracfarm_schema", "fracfarm.record/0"); }), "a value that is not allowed"));
}

TEST_CASE("every dataset of the grammar is missed where it is gone") {
  for (const Record& record : {sample::record(), sample::fdem_record()})
    for (const grammar::DatasetRow& row : grammar::datasets(record.method)) {
      const std::string path = row.spec.path;
      CHECK(has(said_after([&](hid_t f) { H5Ldelete(f, path.c_str(), H5P_DEFAULT); }, record), (path + ": missing").c_str()));
    }
}

TEST_CASE("what follows from an FDEM record's content is compared with it") {
  const auto other_number = [](const char* name) {
    return said_after(
        [&](hid_t f) {
          const double value = 1e-5;
          const h5::Handle group = h5::object(H5Oopen(f, "/failure", H5P_DEFAULT)), space = h5::space(H5Screate(H5S_SCALAR));
          REQUIRE(H5Adelete(group, name) >= 0);
          const h5::Handle made = h5::attribute(H5Acreate2(group, name, H5T_IEEE_F64LE, space, H5P_DEFAULT, H5P_DEFAULT));
          REQUIRE(H5Awrite(made, H5T_NATIVE_DOUBLE, &value) >= 0);
        },
        sample::fdem_record());
  };
  for (const char* name : {"disagreement", "five_step_settled", "settling_wait", "peak_prominence"})
    CHECK(has(other_number(name), (std::string("'") + name + "' differs").c_str()));
}

TEST_CASE("extents of an FDEM record that differ from its number of edges are named") {
  const auto said = [](const char* path, const Shape& shape) {
    return said_after([&](hid_t f) { replace(f, path, shape); }, sample::fdem_record());
  };
  CHECK(has(said("/break_time", {{7}, {7}, true, H5T_IEEE_F64LE}), "it should be"));
  CHECK(has(said("/damage", {{9, 7}, {9, 7}}), "it should be"));
  CHECK(has(said("/tri_nodes", {{640, 2}, {640, 2}, true, H5T_STD_I32LE}), "extent 1 is 2, it should be 3"));
  CHECK(has(said("/node_xyz", {{357, 3}, {357, 3}, true, H5T_IEEE_F64LE}), "chunks are 357 x 3, they should be 357 x 1"));
  CHECK(has(said("/edge", {{1u << 27}, {65536}, true, H5T_STD_I32LE}), "file of this size"));
}

TEST_CASE("chunks hold at most 64 Ki elements, and every element once") {
  using grammar::chunk_dims, grammar::Chunking;
  using Dims = std::vector<std::size_t>;
  CHECK(chunk_dims(Dims{90, 128, 128}, Chunking::rows) == Dims{4, 128, 128});
  CHECK(chunk_dims(Dims{70000, 3}, Chunking::columns) == Dims{65536, 1});
  CHECK(chunk_dims(Dims{32, 24000}, Chunking::blocks) == Dims{32, 2048});
  CHECK(chunk_dims(Dims{65, 24000}, Chunking::blocks) == Dims{33, 1985});
  CHECK(chunk_dims(Dims{9, 100}, Chunking::blocks) == Dims{9, 100});
  for (std::size_t frames = 1; frames < 700; ++frames) {
    const Dims chunk = chunk_dims(Dims{frames, 24000}, Chunking::blocks);
    CHECK((chunk[0] >= 1 && chunk[0] <= 64 && chunk[1] >= 1024 && chunk[0] * chunk[1] <= 65536));
  }
}
