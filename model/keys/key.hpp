#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "model/keys/data.hpp"
#include "model/keys/value.hpp"
#include "model/sheet/sheet.hpp"

/// A key is a row: what it is called, its unit, what it means, where its value is and what is right. Reading, writing, help,
/// JSON and the record follow from the row.
namespace drape::model {

// --- Where a value is --------------------------------------------------------------------------------------------------------

/// A member of a member of ... of a record.
template <auto... members>
struct At {
  template <class Record>
  static auto& in(Record& record) {
    using Owner = typename decltype(owner_of(members...))::type;  // the record or a class derived from it
    using Given = std::conditional_t<std::is_const_v<Record>, const Owner, Owner>;
    return (static_cast<Given&>(record).*....*members);
  }

 private:
  template <class Owner, class Member, class... More>
  static std::type_identity<Owner> owner_of(Member Owner::*, More...);
};

template <auto... members>
inline constexpr At<members...> at;

// --- What is right -----------------------------------------------------------------------------------------------------------

/// Every number of the value, or its text or flag, is read by this member of Value.
template <auto one>
struct Each {};

/// One of these words, which are in the order of the enumeration.
template <const auto& words>
struct OneOf {};

namespace check {
inline constexpr Each<&Value::text> text;
inline constexpr Each<&Value::title> title;
inline constexpr Each<&Value::flag> flag;
inline constexpr Each<&Value::number> number;
inline constexpr Each<&Value::positive> positive;
inline constexpr Each<&Value::non_negative> non_negative;
inline constexpr Each<&Value::part_or_none> part_or_none;
inline constexpr Each<&Value::up_to_two> up_to_two;
template <const auto& words>
inline constexpr OneOf<words> one_of;
}  // namespace check

template <class Member, auto one>
Member read_as(const Value& value, Each<one>) {
  if constexpr (std::is_same_v<Member, WeftWarp>)
    return value.weft_warp(one);
  else if constexpr (std::is_same_v<Member, Eigen::Vector3d>)
    return value.vector(one);
  else
    return (value.*one)();
}

template <class Member, const auto& words>
Member read_as(const Value& value, OneOf<words>) {
  return static_cast<Member>(value.one_of(words));
}

template <class Member, auto one>
Data data_of(const Member& member, Each<one>) {
  if constexpr (std::is_constructible_v<Data, Member>)
    return member;
  else
    return to_data(member);
}

template <class Enum, const auto& words>
Data data_of(const Enum& member, OneOf<words>) {
  return std::string(words[static_cast<std::size_t>(member)]);
}

// --- Rows --------------------------------------------------------------------------------------------------------------------

struct KeyInfo {
  std::string_view name;  ///< in its table; "section.key" of a scene
  std::string_view unit;  ///< "1": a number without dimension; empty: not a number
  std::string_view description;
  bool necessary = false;
};

/// A unit, of some keys one that depends on the others.
template <class Record>
struct Unit {
  constexpr Unit(const char* only) : text(only) {}  // NOLINT(google-explicit-constructor): most rows have a text
  constexpr Unit(const char* all, std::string_view (*choose)(const Record&)) : text(all), of(choose) {}

  std::string_view text;
  std::string_view (*of)(const Record&) = nullptr;
};

template <class Record>
struct Key : KeyInfo {
  template <auto... members, class Check>
  constexpr Key(std::string_view called, Unit<Record> in, std::string_view means, At<members...> /*where*/, Check /*right*/,
                bool required = false)
      : KeyInfo{called, in.text, means, required},
        unit_of(in.of),
        read([](const Value& value, Record& record) {
          auto& member = At<members...>::in(record);
          member = read_as<std::remove_reference_t<decltype(member)>>(value, Check());
        }),
        data([](const Record& record) { return data_of(At<members...>::in(record), Check()); }) {}

  /// What is more than a member.
  constexpr Key(std::string_view called, Unit<Record> in, std::string_view means, void (*own_read)(const Value&, Record&),
                Data (*own_data)(const Record&), bool required = false)
      : KeyInfo{called, in.text, means, required}, unit_of(in.of), read(own_read), data(own_data) {}

  std::string_view unit_in(const Record& record) const { return unit_of == nullptr ? unit : unit_of(record); }

  std::string_view (*unit_of)(const Record&);
  void (*read)(const Value&, Record&);
  Data (*data)(const Record&);
};

/// Throws SceneError unless every entry of a table is one of the keys, and none is missing that is necessary. `what` has these
/// keys: "pin".
void require_keys(const Value& table, std::string_view what, const std::vector<KeyInfo>& keys);

template <class Record>
void read_entries(const Value& table, std::span<const Key<Record>> keys, Record& record) {
  for (const Key<Record>& key : keys)
    if (const toml::node* node = table.table().get(key.name)) key.read(table.child(key.name, *node), record);
}

template <class Record>
void read_table(const Value& table, std::string_view what, std::span<const Key<Record>> keys, Record& record) {
  require_keys(table, what, {keys.begin(), keys.end()});
  read_entries(table, keys, record);
}

/// The entries that are not left out.
template <class Record>
Entries entries_of(std::span<const Key<Record>> keys, const Record& record) {
  Entries entries;
  for (const Key<Record>& key : keys)
    if (Data data = key.data(record); !std::holds_alternative<std::monostate>(data))
      entries.push_back({std::string(key.name), std::move(data)});
  return entries;
}

}  // namespace drape::model
