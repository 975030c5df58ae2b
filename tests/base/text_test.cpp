#include "common/base/text.hpp"

#include <catch2/catch.hpp>

#include <array>
#include <limits>

#include "common/base/terminal.hpp"

using namespace fracfarm;

TEST_CASE("the nearest name is suggested only where it is near") {
  static constexpr std::array<std::string_view, 3> names{"tungsten", "aluminum", "steel"};
  CHECK(nearest("tungstn", names) == "tungsten");
  CHECK(nearest("alumnium", names) == "aluminum");
  CHECK(nearest("granite", names).empty());
  CHECK(nearest("", names).empty());
}

TEST_CASE("numbers print shortest and read back the same") {
  CHECK(shortest(0.1) == "0.1");
  CHECK(shortest(1e-6) == "1e-06");
  CHECK(shortest(5.868e-7) == "5.868e-07");
  CHECK(shortest(std::numeric_limits<double>::infinity()) == "inf");
  CHECK(std::stod(shortest(0.1 + 0.2)) == 0.1 + 0.2);
}

TEST_CASE("durations and quantities read as people say them") {
  CHECK(duration_text(0.85) == "850 ms");
  CHECK(duration_text(12.34) == "12.3 s");
  CHECK(duration_text(245) == "4 min 05 s");
  CHECK(duration_text(11520) == "3 h 12 min");
  CHECK(duration_text(187200) == "2 d 04 h");
  CHECK(engineering(6.91e6, "Pa") == "6.91 MPa");
  CHECK(engineering(4.43e-4, "s") == "443 us");
  CHECK(bytes_text(750000) == "750 kB");
}

TEST_CASE("tables align columns, numbers to the right") {
  CHECK(table_text({{"name", "n"}, {"a", "10"}, {"bcd", "9"}}) == "name   n\na     10\nbcd    9\n");
}
