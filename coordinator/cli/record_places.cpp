#include "coordinator/cli/record_places.hpp"

#include <nlohmann/json.hpp>

namespace fracfarm::cli {
namespace {

using nlohmann::json;

constexpr int rows_at_once = 5000;

struct Rows {
  std::vector<RecordPlace> places;
  bool more = false;
};

Result<Rows> ask_rows(FarmLink& link, const std::filesystem::path& farm, std::uint64_t after, int limit) {
  const Result<wire::Answer> answer = link.ask("records", {{"after", after}, {"limit", limit}});
  if (!answer) return tl::unexpected(answer.error());
  const json body = json::parse(answer->body);
  Rows rows;
  for (const json& it : body["records"])  // an absolute store stays as it is
    rows.places.push_back({it.value("id", std::uint64_t{0}), it.value("key", ""), farm / it.value("store", "") / it.value("shard", ""),
                           it.value("offset", std::uint64_t{0}), it.value("length", std::uint64_t{0}), it.value("sha256", "")});
  rows.more = body.value("more", false) && !rows.places.empty();
  return rows;
}

}  // namespace

Result<std::vector<RecordPlace>> record_places(FarmLink& link, const std::filesystem::path& farm,
                                               const std::function<bool(std::uint64_t)>& wanted) {
  std::vector<RecordPlace> places;
  std::uint64_t after = 0;
  for (bool more = true; more;) {
    Result<Rows> rows = ask_rows(link, farm, after, rows_at_once);
    if (!rows) return tl::unexpected(rows.error());
    for (RecordPlace& place : rows->places) {
      after = place.job;
      if (wanted(place.job)) places.push_back(std::move(place));
    }
    more = rows->more;
  }
  return places;
}

Result<std::optional<RecordPlace>> record_place(FarmLink& link, const std::filesystem::path& farm, std::uint64_t job) {
  Result<Rows> rows = ask_rows(link, farm, job - 1, 1);
  if (!rows) return tl::unexpected(rows.error());
  if (rows->places.empty() || rows->places.front().job != job) return std::nullopt;
  return rows->places.front();
}

}  // namespace fracfarm::cli
