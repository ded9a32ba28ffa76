// Common code of the programs with another vendor's DDS (Fast DDS). They know only the ROS 2 names
// of Thimble.
#pragma once

#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/domain/DomainParticipantListener.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/TypeSupport.hpp>

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "ros_messagesPubSubTypes.h"

using namespace eprosima::fastdds::dds;  // NOLINT: part of one program only
using Clock = std::chrono::steady_clock;

/// Stores the user data of writers by topic: the hash of their type.
class Discovery : public DomainParticipantListener {
 public:
  void on_publisher_discovery(DomainParticipant*,
                              eprosima::fastrtps::rtps::WriterDiscoveryInfo&& found) override {
    const std::scoped_lock lock(mutex_);
    const auto& data = found.info.m_qos.m_userData;
    user_data_[found.info.topicName().c_str()] = std::string(data.begin(), data.end());
  }
  /// Prints a line for each topic.
  void print() {
    const std::scoped_lock lock(mutex_);
    for (const auto& [topic, data] : user_data_)
      std::printf("%s says %s\n", topic.c_str(), data.c_str());
  }

 private:
  std::mutex mutex_;
  std::map<std::string, std::string> user_data_;
};

inline Discovery discovery;
inline DomainParticipant* participant = nullptr;
inline Publisher* publisher = nullptr;
inline Subscriber* subscriber = nullptr;

/// Joins a domain; false on failure.
inline bool enter(const char* domain) {
  participant = DomainParticipantFactory::get_instance()->create_participant(
      static_cast<std::uint32_t>(std::atoi(domain)), PARTICIPANT_QOS_DEFAULT, &discovery,
      StatusMask::none());
  if (participant == nullptr) return false;
  publisher = participant->create_publisher(PUBLISHER_QOS_DEFAULT);
  subscriber = participant->create_subscriber(SUBSCRIBER_QOS_DEFAULT);
  return publisher != nullptr && subscriber != nullptr;
}

template <class Type>
Topic* topic(const std::string& name) {
  TypeSupport type(new Type());
  type.register_type(participant);
  return participant->create_topic(name, type.get_type_name(), TOPIC_QOS_DEFAULT);
}

template <class Message, class Type>
class Heard {
 public:
  /// `late`: also receives messages that were sent before it joined.
  explicit Heard(const std::string& name, bool late = false) : name_(name) {
    DataReaderQos qos = DATAREADER_QOS_DEFAULT;
    qos.reliability().kind = RELIABLE_RELIABILITY_QOS;
    qos.history().kind = KEEP_LAST_HISTORY_QOS;
    qos.history().depth = 100;
    if (late) qos.durability().kind = TRANSIENT_LOCAL_DURABILITY_QOS;
    reader_ = subscriber->create_datareader(topic<Type>(name), qos);
  }
  /// Calls `work` with each received message.
  template <class Call>
  void each(Call call) {
    SampleInfo info;
    Message message;
    while (reader_->take_next_sample(&message, &info) == ReturnCode_t::RETCODE_OK) {
      if (!info.valid_data) continue;
      ++count_;
      call(message);
    }
  }
  long count() const { return count_; }
  DataReader* reader() const { return reader_; }
  void print() const { std::printf("%s %ld\n", name_.c_str(), count_); }

 private:
  std::string name_;
  DataReader* reader_;
  long count_ = 0;
};

template <class Type>
DataWriter* writer(const std::string& name) {
  return publisher->create_datawriter(topic<Type>(name), DATAWRITER_QOS_DEFAULT);
}

/// Uses the topics like a program that was written for the Omni's drivers.
int play_omni(double seconds);
/// Advances a run by steps. If it has one arm, also requests a force. `spaces`: the namespace of
/// each arm, "/left", or "".
int play_steps(long steps, const std::vector<std::string>& spaces);
