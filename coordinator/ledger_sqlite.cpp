#include "coordinator/ledger_sqlite.hpp"

#include <fmt/format.h>
#include <sqlite3.h>

#include <cassert>
#include <utility>

namespace fracfarm {
namespace {

[[noreturn]] void refuse(sqlite3* handle, int code, std::string_view doing) {
  throw LedgerError(fmt::format("the ledger failed while {}: {} ({})", doing, handle ? sqlite3_errmsg(handle) : sqlite3_errstr(code),
                                sqlite3_errstr(code)));
}

void demand(sqlite3_stmt* statement, int code) {
  if (code != SQLITE_OK) refuse(sqlite3_db_handle(statement), code, "binding a value");
}

// Before SQLite's first use in the program. Its count of memory is a lock for every allocation, and nobody asks for it.
void set_up_sqlite() {
  static const int once = sqlite3_config(SQLITE_CONFIG_MEMSTATUS, 0);
  (void)once;  // MISUSE where somebody else used SQLite before: then it counts
}

}  // namespace

Rows::Rows(sqlite3_stmt* statement, bool* busy) : statement_(statement), busy_(busy) { *busy_ = true; }

Rows::~Rows() {
  if (!statement_) return;
  sqlite3_reset(statement_);
  sqlite3_clear_bindings(statement_);
  *busy_ = false;
}

Rows::Rows(Rows&& other) noexcept : statement_(std::exchange(other.statement_, nullptr)), busy_(other.busy_) {}

bool Rows::next() {
  const int code = sqlite3_step(statement_);
  if (code == SQLITE_ROW) return true;
  if (code != SQLITE_DONE) refuse(sqlite3_db_handle(statement_), code, fmt::format("running '{}'", sqlite3_sql(statement_)));
  return false;
}

bool Rows::null(int column) const { return sqlite3_column_type(statement_, column) == SQLITE_NULL; }
std::int64_t Rows::integer(int column) const { return sqlite3_column_int64(statement_, column); }
double Rows::real(int column) const { return sqlite3_column_double(statement_, column); }

std::string Rows::text(int column) const {
  const auto* bytes = static_cast<const char*>(sqlite3_column_blob(statement_, column));
  const int length = sqlite3_column_bytes(statement_, column);
  return bytes ? std::string(bytes, static_cast<std::size_t>(length)) : std::string();
}

std::optional<double> Rows::maybe_real(int column) const {
  if (null(column)) return std::nullopt;
  return real(column);
}

void Rows::bind_integer(int at, std::int64_t value) { demand(statement_, sqlite3_bind_int64(statement_, at, value)); }
void Rows::bind_real(int at, double value) { demand(statement_, sqlite3_bind_double(statement_, at, value)); }
void Rows::bind_text(int at, std::string_view value) {
  demand(statement_, sqlite3_bind_text64(statement_, at, value.data() ? value.data() : "", value.size(), SQLITE_TRANSIENT, SQLITE_UTF8));
}
void Rows::bind_blob(int at, std::string_view value) {
  demand(statement_, sqlite3_bind_blob64(statement_, at, value.data() ? value.data() : "", value.size(), SQLITE_TRANSIENT));
}

Database Database::open(const std::filesystem::path& file) {
  set_up_sqlite();
  sqlite3* handle = nullptr;
  const std::string name = file.empty() ? ":memory:" : file.string();
  const int code = sqlite3_open_v2(name.c_str(), &handle,
                                   SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE | SQLITE_OPEN_NOMUTEX | SQLITE_OPEN_EXRESCODE, nullptr);
  Database database(handle);
  if (code != SQLITE_OK) refuse(handle, code, fmt::format("opening {}", name));
  sqlite3_busy_timeout(handle, 5000);
  return database;
}

Database::~Database() {
  for (auto& [sql, kept] : kept_) sqlite3_finalize(kept->statement);
  if (handle_) sqlite3_close(handle_);
}

Database::Database(Database&& other) noexcept : handle_(std::exchange(other.handle_, nullptr)), kept_(std::move(other.kept_)) {
  other.kept_.clear();
}

Database& Database::operator=(Database&& other) noexcept {
  std::swap(handle_, other.handle_);
  std::swap(kept_, other.kept_);
  return *this;
}

void Database::script(const std::string& sql) {
  const int code = sqlite3_exec(handle_, sql.c_str(), nullptr, nullptr, nullptr);
  if (code != SQLITE_OK) refuse(handle_, code, fmt::format("running '{}'", sql.substr(0, 60)));
}

Rows Database::prepare(std::string_view sql) {
  auto found = kept_.find(sql);
  if (found == kept_.end()) {
    sqlite3_stmt* statement = nullptr;
    const int code = sqlite3_prepare_v3(handle_, sql.data(), static_cast<int>(sql.size()), SQLITE_PREPARE_PERSISTENT, &statement, nullptr);
    if (code != SQLITE_OK) refuse(handle_, code, fmt::format("preparing '{}'", sql));
    found = kept_.emplace(std::string(sql), std::make_unique<Kept>(Kept{statement, false})).first;
  }
  assert(!found->second->busy && "this statement is still giving rows");
  return Rows(found->second->statement, &found->second->busy);
}

std::int64_t Database::changes() const { return sqlite3_changes64(handle_); }
std::int64_t Database::last_id() const { return sqlite3_last_insert_rowid(handle_); }

// IMMEDIATE: the write lock is taken here, so that no later statement of the transaction can be refused for a lock.
void Database::begin() { run("BEGIN IMMEDIATE"); }
void Database::commit() { run("COMMIT"); }
void Database::rollback() {
  if (in_transaction()) run("ROLLBACK");
}
bool Database::in_transaction() const { return sqlite3_get_autocommit(handle_) == 0; }

}  // namespace fracfarm
