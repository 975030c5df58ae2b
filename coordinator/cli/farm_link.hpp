// How a verb reaches a farm: through its coordinator where one runs, else by opening the ledger itself. The answers are the same.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "common/base/result.hpp"
#include "common/wire/socket.hpp"
#include "coordinator/campaign_book.hpp"
#include "coordinator/ledger.hpp"

namespace fracfarm::cli {

class FarmLink {
 public:
  // With `make` a farm that is not there is made. Errors: NODE_LOST where there is no farm or its holder does not answer.
  static Result<FarmLink> open(const std::filesystem::path& farm, bool make = false);

  // The answer's body; its exit code beside it. Where the coordinator has ended since, a request that changes nothing is answered from its
  // ledger. Errors: NODE_LOST where nobody answers.
  Result<wire::Answer> ask(const std::string& verb, const nlohmann::json& arguments);

  bool served() const { return client_.has_value(); }  // a coordinator runs

 private:
  struct Own {
    Ledger ledger;
    CampaignBook book;
  };
  Result<wire::Reply> wait_for_coordinator(const wire::Ask& request);
  bool take_over();

  std::filesystem::path farm_;
  std::unique_ptr<Own> own_;
  std::optional<wire::Client> client_;
};

}  // namespace fracfarm::cli
