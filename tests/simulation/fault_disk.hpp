// A disk in memory under the real SQLite, with everything that a disk may do: it counts the calls, fails the one it is told to, cuts the
// power in the middle of a write, and after a power cut keeps, loses or tears what was not synced. After a failed sync the pages that it
// did not take count as clean, as they do under Linux: a later sync that succeeds says nothing about them.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "common/base/random.hpp"

namespace fracfarm::simulation {

enum class Trouble { none, no_space, io_error, short_write, torn_page, lost_writes, killed, failed_sync };
std::string name_of(Trouble trouble);

class FaultDisk {
 public:
  enum class Call { open, read, write, truncate, sync, remove };

  explicit FaultDisk(std::uint64_t seed) : random_(seed, 2, 0) {}

  // SQLite opens its files here from now on, in this process; one disk at a time.
  static void use(FaultDisk& disk);
  static bool may_have(Call call, Trouble trouble);

  // The call after `calls` more ends so; a trouble that the call cannot have waits for one that can. torn_page, lost_writes and killed end
  // the process that uses the disk: until revive(), no call succeeds.
  void plan(std::uint64_t calls, Trouble trouble) { planned_at_ = calls_.size() + calls, planned_ = trouble; }
  bool planned() const { return planned_ != Trouble::none; }
  void forget_plan() { planned_ = Trouble::none; }
  bool dead() const { return dead_; }
  void kill() { dead_ = true; }  // the process: what it wrote stays
  void cut_power();              // what was not synced is kept, lost or torn
  void revive();                 // another process may open the files

  const std::vector<Call>& calls() const { return calls_; }
  void believe_failed_syncs() { believes_failed_syncs_ = true; }  // a known bug: ask again until it says yes

  // --- what SQLite calls; SQLite's codes ---
  struct Write {
    std::int64_t offset = 0;
    std::string bytes;
    bool cuts = false;  // the file ends at offset
  };
  struct File {
    std::string now, durable;
    std::vector<Write> unsynced;
    std::vector<std::unique_ptr<char[]>> shared;  // the WAL index: memory, not disk
  };
  File* open(const std::string& name, bool create, int& code);
  int read(File& file, void* to, int length, std::int64_t offset);
  int write(File& file, const void* from, int length, std::int64_t offset);
  int truncate(File& file, std::int64_t length);
  int sync(File& file);
  int remove(const std::string& name);
  bool exists(const std::string& name) const { return files_.contains(name); }
  void* shared_memory(File& file, int region, int size);
  int random_bytes(char* to, int length);

 private:
  Trouble turn(Call call);  // counts it; the trouble that it shall have
  void put(File& file, Write write);
  static void apply(std::string& bytes, const Write& write);

  RandomStream random_;
  std::map<std::string, std::unique_ptr<File>> files_;
  std::vector<std::unique_ptr<File>> removed_;  // a handle may still point to them
  std::vector<Call> calls_;
  std::uint64_t planned_at_ = 0;
  Trouble planned_ = Trouble::none;
  bool dead_ = false;
  bool believes_failed_syncs_ = false;
};

}  // namespace fracfarm::simulation
