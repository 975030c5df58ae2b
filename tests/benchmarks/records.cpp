// Everything beside the solve, part by part, on the record of a real run: what the kept-alive child does, then what the worker does.
#include <benchmark/benchmark.h>

#include <unistd.h>

#include <filesystem>

#include "common/base/atomic_file.hpp"
#include "common/base/clock.hpp"
#include "common/base/hash.hpp"
#include "common/record/check.hpp"
#include "common/record/chunk_codec.hpp"
#include "common/record/content.hpp"
#include "common/record/grammar.hpp"
#include "common/record/writer.hpp"
#include "tests/benchmarks/real_run.hpp"
#include "worker/judge.hpp"
#include "worker/shard.hpp"

namespace fracfarm::benchmarks {
namespace {

namespace fs = std::filesystem;

class Folder {
 public:
  Folder() : path_(fs::temp_directory_path() / ("fracfarm-timings-" + std::to_string(::getpid()))) { fs::create_directories(path_); }
  ~Folder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

void say_size(benchmark::State& state) {
  state.counters["frames"] = static_cast<double>(real_run().record.phase_field.psi.size());
  state.counters["bytes"] = static_cast<double>(real_run().bytes.size());
}

// The record that a run hands over: making one is part of the solve, so copying one is left out of the time.
template <class Act>
void on_copies(benchmark::State& state, Act act) {
  for (auto _ : state) {
    state.PauseTiming();
    Record record = real_run().record;
    state.ResumeTiming();
    act(std::move(record));
  }
}

void round(benchmark::State& state) {
  on_copies(state, [](Record record) { benchmark::DoNotOptimize(as_stored(std::move(record))); });
}

void rules(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(check_content(real_run().record));
}

// Shuffle, deflate and checksum of all frames, as chunks of four.
void deflate(benchmark::State& state) {
  const Record record = as_stored(real_run().record);
  std::string frames;
  for (const std::vector<float>& frame : record.phase_field.psi)
    frames.append(reinterpret_cast<const char*>(frame.data()), frame.size() * sizeof(float));
  const std::size_t chunk = 4 * record.phase_field.psi.front().size() * sizeof(float);
  for (auto _ : state)
    for (std::size_t at = 0; at + chunk <= frames.size(); at += chunk)
      benchmark::DoNotOptimize(encode_chunk(std::string_view(frames).substr(at, chunk), sizeof(float)).data());
}

void make(benchmark::State& state) {
  on_copies(state, [](Record record) { benchmark::DoNotOptimize(record_bytes(std::move(record))); });
  say_size(state);
}

void digest(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(sha256_hex(real_run().bytes));
}

// What a worker's child does after the solve.
void write_for_worker(benchmark::State& state) {
  const Folder folder;
  on_copies(state, [&](Record record) {
    benchmark::DoNotOptimize(write_record(std::move(record), folder.path() / "record.h5", Keeping::scratch));
  });
}

// What `fracfarm solve` does after the solve: synced, read back, compared.
void write_durable(benchmark::State& state) {
  const Folder folder;
  on_copies(state, [&](Record record) {
    benchmark::DoNotOptimize(write_record(std::move(record), folder.path() / "record.h5", Keeping::durable));
  });
}

void validate(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(check_record_bytes(real_run().bytes));
  say_size(state);
}

// What the worker does with a finished record: read, judge, append, sync, read back and compare.
void keep(benchmark::State& state) {
  const Folder folder;
  const fs::path file = folder.path() / "record.h5";
  SystemClock clock;
  worker::ShardWriter shard({.store = folder.path() / "store", .worker = "bench"}, clock);
  if (!write_unsynced(file, real_run().bytes)) return state.SkipWithError("no folder to write into");
  for (auto _ : state) {
    const std::string bytes = read_file(file, std::uint64_t{1} << 30).value();
    if (!worker::judge_record(bytes, real_run().task.key, real_run().summary)) return state.SkipWithError("refused");
    if (!shard.append(real_run().task.key + ".h5", bytes, real_run().summary.record_sha256)) return state.SkipWithError("not appended");
    if (!shard.commit().front()) return state.SkipWithError("not kept");
  }
}

BENCHMARK(round)->Name("record/round")->Unit(benchmark::kMillisecond);
BENCHMARK(rules)->Name("record/rules")->Unit(benchmark::kMillisecond);
BENCHMARK(deflate)->Name("record/deflate")->Unit(benchmark::kMillisecond);
BENCHMARK(make)->Name("record/make")->Unit(benchmark::kMillisecond);
BENCHMARK(digest)->Name("record/digest")->Unit(benchmark::kMillisecond);
BENCHMARK(write_for_worker)->Name("record/make_and_write")->Unit(benchmark::kMillisecond);
BENCHMARK(write_durable)->Name("record/make_and_write_durable")->Unit(benchmark::kMillisecond);
BENCHMARK(validate)->Name("record/validate")->Unit(benchmark::kMillisecond);
BENCHMARK(keep)->Name("record/judge_and_keep")->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace fracfarm::benchmarks
