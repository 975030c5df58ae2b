// A ledger as a release of the first schema left it: of a campaign's three jobs two are rows, made one by one and with another's ids before
// them; that of position 2 was still to come.
#pragma once

#include "coordinator/ledger_schema.hpp"
#include "tests/coordinator/farm_fixture.hpp"

namespace fracfarm::test {

inline Result<void> make_half(Database& database) {
  if (Result<void> made = migrate(database, migrations().first(1)); !made) return made;
  database.run("INSERT INTO campaigns VALUES(1, 'half', ?1, ?2, 3, 2, 0, 0.0)", canonical_text(*parse_campaign(campaign_text(3), "test")),
               build);
  for (const int position : {0, 1})
    database.run(
        "INSERT INTO jobs(id, key, campaign, position, method, material, load, crack_set, sample_id, state) VALUES(?1, randomblob(32), 1, "
        "?2, 'phase_field', 'pbx', 'uniaxial', 'orthogonal', ?3, ?4)",
        7 + position, position, position + 1, position == 0 ? "READY" : "QUARANTINED");
  return {};
}

}  // namespace fracfarm::test
