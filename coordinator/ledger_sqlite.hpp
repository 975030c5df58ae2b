// A thin door to SQLite: a database, cached statements, rows, transactions. Only the ledger's own .cpp files include sqlite3.h.
// A ledger that cannot be read or written has no second way: every SQLite error is thrown as LedgerError and ends the program that holds
// the ledger.
#pragma once

#include <concepts>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <unordered_map>

struct sqlite3;
struct sqlite3_stmt;

namespace fracfarm {

// SQLITE_FULL, IOERR, CORRUPT and whatever else SQLite says no with, in words. Never caught but by a program's outermost function.
class LedgerError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct Blob {
  std::string_view bytes;
};

// The rows of one running statement; the statement is reset when this ends.
class Rows {
 public:
  Rows(sqlite3_stmt* statement, bool* busy);
  ~Rows();
  Rows(Rows&& other) noexcept;
  Rows(const Rows&) = delete;
  Rows& operator=(const Rows&) = delete;
  Rows& operator=(Rows&&) = delete;

  bool next();  // false: no more
  bool null(int column) const;
  std::int64_t integer(int column) const;  // 0 where null
  double real(int column) const;
  std::string text(int column) const;  // also the bytes of a blob
  std::optional<double> maybe_real(int column) const;

 private:
  friend class Database;
  void bind_integer(int at, std::int64_t value);
  void bind_real(int at, double value);
  void bind_text(int at, std::string_view value);
  void bind_blob(int at, std::string_view value);

  template <std::integral T>
  void bind(int at, T value) {
    bind_integer(at, static_cast<std::int64_t>(value));
  }
  void bind(int at, double value) { bind_real(at, value); }
  void bind(int at, std::string_view value) { bind_text(at, value); }
  void bind(int at, const std::string& value) { bind_text(at, value); }
  void bind(int at, const char* value) { bind_text(at, value); }
  void bind(int at, Blob value) { bind_blob(at, value.bytes); }
  void bind(int, std::nullopt_t) {}
  template <class T>
  void bind(int at, const std::optional<T>& value) {
    if (value) bind(at, *value);
  }

  sqlite3_stmt* statement_;
  bool* busy_;
};

class Database {
 public:
  // Opens or makes the file; an empty path is a database in memory.
  static Database open(const std::filesystem::path& file);
  ~Database();
  Database(Database&&) noexcept;
  Database& operator=(Database&&) noexcept;

  void script(const std::string& sql);  // several statements, no values
  // One statement, kept prepared by its text; values fill ?1, ?2, ... in order. A null is std::nullopt.
  template <class... Values>
  Rows query(std::string_view sql, const Values&... values) {
    Rows rows = prepare(sql);
    int at = 0;
    (rows.bind(++at, values), ...);
    return rows;
  }
  // Runs it to its end; gives the number of rows changed.
  template <class... Values>
  std::int64_t run(std::string_view sql, const Values&... values) {
    {
      Rows rows = query(sql, values...);
      while (rows.next()) {
      }
    }
    return changes();
  }
  std::int64_t last_id() const;

  void begin();
  void commit();
  void rollback();  // also where there is nothing to roll back
  bool in_transaction() const;

 private:
  struct Kept {
    sqlite3_stmt* statement = nullptr;
    bool busy = false;
  };
  explicit Database(sqlite3* handle) : handle_(handle) {}
  Rows prepare(std::string_view sql);
  std::int64_t changes() const;

  sqlite3* handle_ = nullptr;
  struct Hash : std::hash<std::string_view> {
    using is_transparent = void;
  };
  std::unordered_map<std::string, std::unique_ptr<Kept>, Hash, std::equal_to<>> kept_;
};

}  // namespace fracfarm
