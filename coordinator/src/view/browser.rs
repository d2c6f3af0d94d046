//! The live page: HTTP on the loopback interface, frames as server-sent events. The only file that imports
//! `tiny_http`.

use super::ViewError;
use super::frame::{Frame, News, Slot};
use super::viewers::Viewers;
use crate::page;
use crate::page::scene;
use std::io::{self, Write};
use std::net::Ipv4Addr;
use std::sync::Arc;
use std::thread::{self, JoinHandle};
use std::time::Duration;
use tiny_http::{Header, Request, Response, Server};
use vodca::params::Params;
use vodca::scenario::Scenario;

/// How long a silent run goes without a word to a viewer; a viewer that is gone is noticed then.
const HEARTBEAT: Duration = Duration::from_secs(5);
const EVENTS: &str =
    "HTTP/1.1 200 OK\r\nContent-Type: text/event-stream\r\nCache-Control: no-store\r\nConnection: close\r\n\r\n";

/// Serves the live page until it is closed.
pub(super) struct BrowserView {
    server: Arc<Server>,
    address: String,
    viewers: Viewers,
    thread: JoinHandle<()>,
}

/// What every viewer's thread needs.
struct Shown {
    slot: Arc<Slot>,
    page: String,
}

impl BrowserView {
    /// Listens on `port` of 127.0.0.1 only.
    pub(super) fn open(
        port: u16,
        slot: Arc<Slot>,
        scenario: &Scenario,
        params: &Params,
        horizons: &str,
    ) -> Result<Self, ViewError> {
        let failed = |reason: String| ViewError::Port { port, reason };
        let server = Server::http((Ipv4Addr::LOCALHOST, port)).map_err(|error| failed(error.to_string()))?;
        let server = Arc::new(server);
        let bound = server.server_addr().to_ip().ok_or_else(|| failed("it has no address".into()))?;
        let shown = Arc::new(Shown { slot, page: page::live(scenario, params, horizons) });
        let viewers = Viewers::default();
        let (serving, counted) = (server.clone(), viewers.clone());
        let thread = thread::spawn(move || {
            while let Ok(request) = serving.recv() {
                answer(request, &shown, &counted);
            }
        });
        Ok(Self { server, address: format!("http://{bound}/"), viewers, thread })
    }

    /// Where to look.
    pub(super) fn address(&self) -> &str {
        &self.address
    }

    /// Gives the viewers a moment to take the last frame, then ends. One that does not is left behind.
    pub(super) fn close(self) {
        self.viewers.farewell();
        self.server.unblock();
        let _ = self.thread.join(); // a panic in it has been reported on standard error
    }
}

fn answer(request: Request, shown: &Arc<Shown>, viewers: &Viewers) {
    // A page of another origin must not read the run by pointing its own name at 127.0.0.1.
    let local = |host: &str| host.starts_with("127.0.0.1:") || host.starts_with("localhost:");
    let host = request.headers().iter().find(|header| header.field.equiv("Host"));
    let answered = match request.url() {
        _ if !host.is_some_and(|header| local(header.value.as_str())) => request.respond(Response::empty(403)),
        "/" => {
            let html = Header::from_bytes("Content-Type", "text/html; charset=utf-8").into_iter();
            let response = html.fold(Response::from_string(shown.page.clone()), Response::with_header);
            request.respond(response)
        }
        "/frames" => match viewers.enter() {
            None => request.respond(Response::empty(503)),
            Some(guest) => {
                let shown = shown.clone();
                thread::spawn(move || {
                    let _ = send_frames(request.into_writer(), &shown); // a viewer that is gone is none
                    drop(guest);
                });
                Ok(())
            }
        },
        _ => request.respond(Response::empty(404)),
    };
    if let Err(error) = answered {
        tracing::debug!("a viewer left before it was answered: {error}");
    }
}

/// Writes frames as events until the run ends or the viewer is gone. A slow one blocks only here.
fn send_frames(mut viewer: impl Write, shown: &Shown) -> io::Result<()> {
    viewer.write_all(EVENTS.as_bytes())?;
    viewer.flush()?;
    let mut seen = 0;
    loop {
        match shown.slot.wait(seen, HEARTBEAT) {
            News::Frame(frame, number) => {
                seen = number;
                write_event(&mut viewer, &frame)?;
            }
            News::Nothing => viewer.write_all(b": still there\n\n")?,
            News::Ended => {
                viewer.write_all(b"event: end\ndata: {}\n\n")?;
                return viewer.flush();
            }
        }
        viewer.flush()?;
    }
}

fn write_event(viewer: &mut impl Write, frame: &Frame) -> io::Result<()> {
    writeln!(viewer, "data: {}\n", scene::frame(frame))
}

#[cfg(test)]
mod tests {
    use super::super::frame::tests::{sample, sample_of};
    use super::*;
    use crate::record::samples;
    use std::io::Read;
    use std::net::TcpStream;

    fn open() -> (Arc<Slot>, BrowserView) {
        let slot = Arc::new(Slot::default());
        let (scenario, params) = (samples::scenario(2), Params::safe());
        let view = BrowserView::open(0, slot.clone(), &scenario, &params, "fixed:3").unwrap();
        (slot, view)
    }

    fn ask(view: &BrowserView, path: &str, host: &str) -> TcpStream {
        let address = view.address().trim_start_matches("http://").trim_end_matches('/');
        let mut stream = TcpStream::connect(address).unwrap();
        stream.set_read_timeout(Some(Duration::from_secs(30))).unwrap();
        write!(stream, "GET {path} HTTP/1.1\r\nHost: {host}\r\nConnection: close\r\n\r\n").unwrap();
        stream
    }

    fn text(mut stream: TcpStream) -> String {
        let mut text = String::new();
        stream.read_to_string(&mut text).unwrap();
        text
    }

    #[test]
    fn page_and_frames_are_served_until_the_run_ends() {
        let (slot, view) = open();
        assert!(view.address().starts_with("http://127.0.0.1:"));
        let page = text(ask(&view, "/", "127.0.0.1:1"));
        assert!(page.starts_with("HTTP/1.1 200") && page.contains("EventSource"), "{page}");
        assert!(text(ask(&view, "/other", "localhost:1")).starts_with("HTTP/1.1 404"));
        let viewer = ask(&view, "/frames", "127.0.0.1:1");
        assert!(slot.offer(sample(7)).is_none());
        slot.end(None);
        let events = text(viewer);
        assert!(events.contains("\"tick\":7") && events.ends_with("event: end\ndata: {}\n\n"), "{events}");
        view.close();
    }

    #[test]
    fn a_browser_that_never_reads_holds_up_neither_the_run_nor_the_others() {
        let slot = Arc::new(Slot::default());
        let view = BrowserView::open(0, slot.clone(), &samples::scenario(150), &Params::safe(), "fixed:3").unwrap();
        let _deaf = ask(&view, "/frames", "127.0.0.1:1");
        let other = ask(&view, "/frames", "127.0.0.1:1");
        let reader = thread::spawn(move || text(other));
        // Far more than the system buffers for a socket.
        for tick in 0..400 {
            let _ = slot.offer(sample_of(150, tick));
            thread::sleep(Duration::from_millis(1));
        }
        slot.end(Some(sample_of(150, 400)));
        let events = reader.join().unwrap();
        assert!(events.contains("\"tick\":400") && events.ends_with("event: end\ndata: {}\n\n"));
        view.close(); // although the deaf one is still there
    }

    #[test]
    fn another_host_name_is_refused() {
        let (slot, view) = open();
        assert!(text(ask(&view, "/", "evil.example:80")).starts_with("HTTP/1.1 403"));
        slot.end(None);
        view.close();
    }

    #[test]
    fn a_taken_port_is_one_clear_error() {
        let (slot, view) = open();
        let port = view.address().trim_end_matches('/').rsplit(':').next().unwrap().parse().unwrap();
        let again = BrowserView::open(port, slot.clone(), &samples::scenario(2), &Params::safe(), "fixed:3");
        let message = again.err().map(|error| error.to_string()).unwrap();
        assert!(message.contains(&port.to_string()) && message.contains("another port"), "{message}");
        slot.end(None);
        view.close();
    }
}
