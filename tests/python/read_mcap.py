"""Reads a run's log back with the packages that Foxglove publishes: read_mcap.py LOG ROBOTS TICKS"""
import json
import sys

from mcap.reader import make_reader
from mcap_protobuf.decoder import DecoderFactory

log, robots, ticks = sys.argv[1], int(sys.argv[2]), int(sys.argv[3])
seen = {}
with open(log, "rb") as file:
    reader = make_reader(file, decoder_factories=[DecoderFactory()])
    for schema, channel, message in reader.iter_messages():
        seen.setdefault(channel.topic, []).append(message.log_time)
        if schema.name == "vodca.Team":
            values = json.loads(message.data)
            assert len(values["robots"]) == robots, values
            assert all(1 <= robot["horizon"] <= 49 for robot in values["robots"]), values
with open(log, "rb") as file:
    reader = make_reader(file, decoder_factories=[DecoderFactory()])
    for schema, channel, message, decoded in reader.iter_decoded_messages(topics=["/layout", "/scene", "/poses"]):
        if channel.topic == "/scene":
            assert len(decoded.entities) == robots, channel.topic
            assert all(entity.texts and entity.lines[0].points for entity in decoded.entities)
        elif channel.topic == "/poses":
            assert len(decoded.poses) == robots and decoded.frame_id == "world"
        else:
            assert len(decoded.entities) >= robots, "set-points and obstacles"
assert {topic: len(times) for topic, times in seen.items()} == {
    "/layout": 1, "/scene": ticks, "/poses": ticks, "/team": ticks}, {t: len(v) for t, v in seen.items()}
assert seen["/scene"][0] == 0 and seen["/scene"] == sorted(seen["/scene"])
print("the log reads back")
