//! The team in Foxglove or Lichtblick: a WebSocket on the loopback interface that speaks Foxglove's documented
//! protocol, version 1 (`foxglove.websocket.v1`). The only file that imports `tungstenite`.
//!
//! A viewer is told the channels of `record/scene_messages.rs`, subscribes to some, and gets the newest tick at its own
//! pace. Any program on this machine may connect, a page in its browser too.

use super::ViewError;
use super::frame::{News, Slot};
use super::viewers::Viewers;
use crate::record::scene_messages;
use policy::encoding::base64;
use serde_json::{Value, json};
use std::io::ErrorKind;
use std::net::{Ipv4Addr, TcpListener, TcpStream};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{self, JoinHandle};
use std::time::Duration;
use tungstenite::handshake::server::{ErrorResponse, Request, Response};
use tungstenite::http::{HeaderValue, StatusCode};
use tungstenite::protocol::WebSocketConfig;
use tungstenite::{Error, Message, WebSocket};
use vodca::params::Params;
use vodca::scenario::Scenario;

const PROTOCOL: &str = "foxglove.websocket.v1";
const PROTOCOL_HEADER: &str = "Sec-WebSocket-Protocol";
/// How long a viewer may take to introduce itself.
const HANDSHAKE: Duration = Duration::from_secs(5);
/// How long a viewer's thread listens to it between two frames.
const LISTEN: Duration = Duration::from_millis(1);
/// How long it waits for a frame before it listens again.
const PAUSE: Duration = Duration::from_millis(50);
/// A viewer that takes nothing for so long is gone.
const STUCK: Duration = Duration::from_secs(10);
/// Largest message that a viewer may send, bytes.
const MOST_BYTES: usize = 64 << 10;
/// Most subscriptions of one viewer.
const MOST_SUBSCRIPTIONS: usize = 64;
/// First byte of a message with data.
const MESSAGE_DATA: u8 = 1;

/// Serves the scene until it is closed.
pub(super) struct FoxgloveView {
    address: String,
    port: u16,
    viewers: Viewers,
    closing: Arc<AtomicBool>,
    thread: JoinHandle<()>,
}

/// What every viewer's thread needs.
struct Shown {
    slot: Arc<Slot>,
    scenario: Scenario,
    params: Params,
}

/// A viewer and what it wants to see: its own numbers, and places of channels.
struct Viewer {
    socket: WebSocket<TcpStream>,
    subscriptions: Vec<(u32, usize)>,
}

impl FoxgloveView {
    /// Listens on `port` of 127.0.0.1 only.
    pub(super) fn open(port: u16, slot: Arc<Slot>, scenario: &Scenario, params: &Params) -> Result<Self, ViewError> {
        let failed = |error: std::io::Error| ViewError::Port { port, reason: error.to_string() };
        let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, port)).map_err(failed)?;
        let port = listener.local_addr().map_err(failed)?.port();
        let shown = Arc::new(Shown { slot, scenario: scenario.clone(), params: params.clone() });
        let (viewers, closing) = (Viewers::default(), Arc::new(AtomicBool::new(false)));
        let (counted, ends) = (viewers.clone(), closing.clone());
        let thread = thread::spawn(move || {
            for stream in listener.incoming() {
                if ends.load(Ordering::Acquire) {
                    return;
                }
                // Too many viewers, or one that is gone already: it is not answered.
                let (Ok(stream), Some(guest)) = (stream, counted.enter()) else { continue };
                let shown = shown.clone();
                thread::spawn(move || {
                    if let Err(reason) = serve(stream, &shown) {
                        tracing::debug!("a Foxglove viewer left: {reason}");
                    }
                    drop(guest);
                });
            }
        });
        Ok(Self { address: format!("ws://127.0.0.1:{port}"), port, viewers, closing, thread })
    }

    /// Where to connect.
    pub(super) fn address(&self) -> &str {
        &self.address
    }

    /// Gives the viewers a moment to take the last frame, then ends. One that does not is left behind.
    pub(super) fn close(self) {
        self.viewers.farewell();
        self.closing.store(true, Ordering::Release);
        let _ = TcpStream::connect((Ipv4Addr::LOCALHOST, self.port)); // wakes the listener
        let _ = self.thread.join(); // a panic in it has been reported on standard error
    }
}

/// Sends frames until the run ends or the viewer is gone. A slow one blocks only this thread.
fn serve(stream: TcpStream, shown: &Shown) -> Result<(), String> {
    let mut viewer = Viewer::greet(stream).map_err(|error| error.to_string())?;
    viewer.show(shown).map_err(|error| error.to_string())
}

impl Viewer {
    /// Agrees on the protocol and tells which channels there are.
    fn greet(stream: TcpStream) -> Result<Self, Box<dyn std::error::Error>> {
        stream.set_read_timeout(Some(HANDSHAKE))?;
        stream.set_write_timeout(Some(STUCK))?;
        stream.set_nodelay(true)?;
        let limits = WebSocketConfig::default().max_message_size(Some(MOST_BYTES)).max_frame_size(Some(MOST_BYTES));
        // The error of a handshake borrows nothing but is large and generic: its words are enough.
        let socket = tungstenite::accept_hdr_with_config(stream, agree, Some(limits)).map_err(|e| e.to_string())?;
        socket.get_ref().set_read_timeout(Some(LISTEN))?;
        let mut viewer = Self { socket, subscriptions: Vec::new() };
        viewer.tell(&json!({
            "op": "serverInfo", "name": concat!("vodca ", env!("CARGO_PKG_VERSION")), "capabilities": [],
            "sessionId": std::process::id().to_string(),
        }))?;
        let channels: Vec<Value> = scene_messages::channels()
            .iter()
            .enumerate()
            .map(|(id, channel)| {
                let binary = channel.schema_encoding == "protobuf";
                let schema = match binary {
                    true => base64(&channel.description),
                    false => String::from_utf8_lossy(&channel.description).into_owned(),
                };
                json!({
                    "id": id, "topic": channel.topic, "encoding": channel.encoding, "schemaName": channel.schema,
                    "schema": schema, "schemaEncoding": channel.schema_encoding,
                })
            })
            .collect();
        viewer.tell(&json!({ "op": "advertise", "channels": channels }))?;
        Ok(viewer)
    }

    fn show(&mut self, shown: &Shown) -> Result<(), Error> {
        let sample_time = shown.params.model.sample_time;
        let mut seen = 0;
        loop {
            for new in self.hear()? {
                if new.1 == scene_messages::LAYOUT {
                    self.send(new.0, 0, &scene_messages::layout(&shown.scenario, &shown.params))?;
                }
            }
            match shown.slot.wait(seen, PAUSE) {
                News::Frame(frame, number) => {
                    seen = number;
                    let time = scene_messages::nanoseconds(sample_time, frame.tick);
                    for (channel, data) in
                        scene_messages::tick(&shown.scenario, &shown.params, frame.tick, frame.explainer.steps())
                    {
                        for (id, _) in self.subscriptions.clone().into_iter().filter(|(_, wanted)| *wanted == channel) {
                            self.send(id, time, &data)?;
                        }
                    }
                }
                News::Nothing => {}
                News::Ended => {
                    self.socket.close(None)?;
                    return self.socket.flush();
                }
            }
        }
    }

    /// Takes in what the viewer has said; gives the subscriptions that are new.
    fn hear(&mut self) -> Result<Vec<(u32, usize)>, Error> {
        let mut new = Vec::new();
        loop {
            match self.socket.read() {
                Ok(Message::Text(text)) => new.extend(self.subscribe(&text)),
                Ok(_) => {}
                Err(Error::Io(error)) if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut) => {
                    return Ok(new);
                }
                Err(error) => return Err(error),
            }
        }
    }

    /// Carries out `subscribe` and `unsubscribe`; anything else is none of ours.
    fn subscribe(&mut self, text: &str) -> Vec<(u32, usize)> {
        let order: Value = serde_json::from_str(text).unwrap_or_default();
        let number = |value: &Value| value.as_u64().and_then(|number| u32::try_from(number).ok());
        let list = |name: &str| order[name].as_array().cloned().unwrap_or_default();
        let wanted = list("subscriptions").into_iter().filter_map(|wanted| {
            let channel = number(&wanted["channelId"])? as usize;
            Some((number(&wanted["id"])?, channel)).filter(|_| channel < scene_messages::channels().len())
        });
        let before = self.subscriptions.len();
        match order["op"].as_str() {
            Some("subscribe") => {
                self.subscriptions.extend(wanted);
                self.subscriptions.truncate(MOST_SUBSCRIPTIONS);
                self.subscriptions[before.min(self.subscriptions.len())..].to_vec()
            }
            Some("unsubscribe") => {
                let gone: Vec<u32> = list("subscriptionIds").iter().filter_map(number).collect();
                self.subscriptions.retain(|(id, _)| !gone.contains(id));
                Vec::new()
            }
            _ => Vec::new(),
        }
    }

    fn tell(&mut self, what: &Value) -> Result<(), Error> {
        self.socket.send(Message::text(what.to_string()))
    }

    fn send(&mut self, subscription: u32, nanoseconds: u64, data: &[u8]) -> Result<(), Error> {
        let mut message = Vec::with_capacity(13 + data.len());
        message.push(MESSAGE_DATA);
        message.extend_from_slice(&subscription.to_le_bytes());
        message.extend_from_slice(&nanoseconds.to_le_bytes());
        message.extend_from_slice(data);
        self.socket.send(Message::binary(message))
    }
}

/// Accepts clients of our protocol.
#[allow(clippy::result_large_err)] // the library's own type
fn agree(request: &Request, mut response: Response) -> Result<Response, ErrorResponse> {
    let offered = request.headers().get_all(PROTOCOL_HEADER).iter().filter_map(|header| header.to_str().ok());
    if offered.flat_map(|list| list.split(',')).any(|protocol| protocol.trim() == PROTOCOL) {
        response.headers_mut().insert(PROTOCOL_HEADER, HeaderValue::from_static(PROTOCOL));
        return Ok(response);
    }
    let mut refusal = ErrorResponse::new(Some(format!("this server speaks {PROTOCOL}\n")));
    *refusal.status_mut() = StatusCode::BAD_REQUEST;
    Err(refusal)
}

#[cfg(test)]
mod tests {
    use super::super::frame::tests::{sample, sample_of};
    use super::*;
    use crate::record::samples;
    use tungstenite::client::IntoClientRequest;

    fn open(robots: usize) -> (Arc<Slot>, FoxgloveView) {
        let slot = Arc::new(Slot::default());
        let view = FoxgloveView::open(0, slot.clone(), &samples::scenario(robots), &Params::safe()).unwrap();
        assert!(view.address().starts_with("ws://127.0.0.1:"));
        (slot, view)
    }

    type Client = WebSocket<TcpStream>;

    fn connect(view: &FoxgloveView, protocol: &'static str) -> Result<Client, String> {
        let stream = TcpStream::connect(("127.0.0.1", view.port)).unwrap();
        stream.set_read_timeout(Some(Duration::from_secs(30))).unwrap();
        let mut request = view.address().into_client_request().unwrap();
        request.headers_mut().insert(PROTOCOL_HEADER, HeaderValue::from_static(protocol));
        let (client, response) = tungstenite::client(request, stream).map_err(|error| error.to_string())?;
        assert_eq!(response.headers()[PROTOCOL_HEADER], PROTOCOL);
        Ok(client)
    }

    fn json_of(client: &mut Client) -> Value {
        serde_json::from_str(client.read().unwrap().to_text().unwrap()).unwrap()
    }

    /// Subscription, time and data of the next message with data.
    fn data_of(client: &mut Client) -> Option<(u32, u64, Vec<u8>)> {
        let Message::Binary(bytes) = client.read().ok()? else { return None };
        assert_eq!(bytes[0], 1);
        let (id, time) = (bytes[1..5].try_into().unwrap(), bytes[5..13].try_into().unwrap());
        Some((u32::from_le_bytes(id), u64::from_le_bytes(time), bytes[13..].to_vec()))
    }

    fn subscribe(client: &mut Client, id: u32, channel: usize) {
        let order = json!({ "op": "subscribe", "subscriptions": [{ "id": id, "channelId": channel }] });
        client.send(Message::text(order.to_string())).unwrap();
    }

    #[test]
    fn a_viewer_learns_the_channels_and_gets_what_it_subscribed_to_until_the_run_ends() {
        let (slot, view) = open(2);
        let mut client = connect(&view, PROTOCOL).unwrap();
        assert_eq!(json_of(&mut client)["op"], "serverInfo");
        let channels = json_of(&mut client)["channels"].as_array().unwrap().clone();
        let topics: Vec<&str> = channels.iter().map(|channel| channel["topic"].as_str().unwrap()).collect();
        assert_eq!(topics, ["/layout", "/scene", "/poses", "/team"]);
        assert_eq!(channels[1]["schemaName"], "foxglove.SceneUpdate");
        assert_eq!(channels[3]["schemaEncoding"], "jsonschema");

        // The layout comes once per subscriber, at any time; nothing subscribed to `/poses`.
        // Orders are carried out one after the other: when the second is answered, the first was.
        subscribe(&mut client, 41, 3);
        subscribe(&mut client, 40, scene_messages::LAYOUT);
        let (scenario, params) = (samples::scenario(2), Params::safe());
        assert_eq!(data_of(&mut client), Some((40, 0, scene_messages::layout(&scenario, &params))));
        assert!(slot.offer(sample(7)).is_none());
        let (id, time, data) = data_of(&mut client).unwrap();
        assert_eq!((id, time), (41, 7 * 200_000_000));
        let team: Value = serde_json::from_slice(&data).unwrap();
        assert_eq!((&team["tick"], team["robots"].as_array().unwrap().len()), (&json!(7), 2));

        client.send(Message::text(r#"{"op":"unsubscribe","subscriptionIds":[41]}"#)).unwrap();
        subscribe(&mut client, 42, 1);
        subscribe(&mut client, 43, 99);
        client.send(Message::text("nonsense")).unwrap();
        subscribe(&mut client, 44, scene_messages::LAYOUT);
        assert_eq!(data_of(&mut client).map(|(id, ..)| id), Some(44));
        slot.end(Some(sample(8)));
        assert_eq!(data_of(&mut client).map(|(id, time, _)| (id, time)), Some((42, 8 * 200_000_000)));
        assert_eq!(data_of(&mut client), None, "the end");
        view.close();
    }

    #[test]
    fn another_protocol_is_refused() {
        let (slot, view) = open(2);
        let message = connect(&view, "chat").unwrap_err();
        assert!(message.contains("400"), "{message}");
        slot.end(None);
        view.close();
    }

    #[test]
    fn a_viewer_that_never_reads_holds_up_neither_the_run_nor_the_others() {
        let (slot, view) = open(150);
        let mut deaf = connect(&view, PROTOCOL).unwrap();
        (0..4).for_each(|channel| subscribe(&mut deaf, channel as u32, channel));
        let mut other = connect(&view, PROTOCOL).unwrap();
        json_of(&mut other);
        json_of(&mut other);
        subscribe(&mut other, 9, 3);
        // Far more than the system buffers for a socket.
        for tick in 0..400 {
            let frame = sample_of(150, tick);
            let _ = slot.offer(frame); // given back when a viewer has the slot just then
            thread::sleep(Duration::from_millis(1));
        }
        slot.end(Some(sample_of(150, 400)));
        let ticks: Vec<u64> =
            std::iter::from_fn(|| data_of(&mut other)).map(|(_, time, _)| time / 200_000_000).collect();
        assert!(ticks.is_sorted() && ticks.last() == Some(&400), "{ticks:?}");
        view.close(); // although the deaf one is still there
    }
}
