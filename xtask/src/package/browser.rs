//! Pages in a headless Chromium: a server of files on this machine, to which pages send their pictures.

use std::io::{BufRead, BufReader, Read, Write};
use std::net::{TcpListener, TcpStream};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::Arc;
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::thread;
use std::time::{Duration, Instant};

use anyhow::bail;

/// Folders by the beginnings of addresses.
pub(super) type Folders = Vec<(&'static str, PathBuf)>;

/// The names under which browsers with WebGPU are installed.
const PROGRAMS: [&str; 3] = ["chromium", "chromium-browser", "google-chrome"];
/// SwiftShader compiles for seconds, and maps of an environment take seconds too: together two minutes, on a machine with other work many.
const PATIENCE: Duration = Duration::from_secs(600);

/// Answer of a page: the rest of the address after `/result/`, and the bytes.
pub(super) type Answer = (String, Vec<u8>);

/// Opens a page and waits until it has sent `/done`. What it sends to `/failure` is an error.
pub(super) fn answers(folders: Folders, page: &str) -> anyhow::Result<Vec<Answer>> {
    let listener = TcpListener::bind("127.0.0.1:0")?;
    let address = format!("http://127.0.0.1:{}{page}", listener.local_addr()?.port());
    let (sender, receiver) = channel();
    // Ends with the program.
    thread::spawn(move || listen(&listener, folders, &sender));
    let profile = tempfile::tempdir()?;
    let mut browser = Browser(start(profile.path(), &address)?);
    let mut answers = Vec::new();
    let begun = Instant::now();
    while begun.elapsed() < PATIENCE {
        match receiver.recv_timeout(Duration::from_secs(1)) {
            Ok((path, _)) if path == "/done" => return Ok(answers),
            Ok((path, body)) if path == "/failure" => {
                bail!("the page failed: {}", String::from_utf8_lossy(&body))
            }
            Ok((path, body)) => {
                answers.push((path.trim_start_matches("/result/").to_owned(), body));
            }
            Err(RecvTimeoutError::Timeout) => {
                if let Some(status) = browser.0.try_wait()? {
                    bail!("the browser ended by itself: {status}");
                }
            }
            Err(RecvTimeoutError::Disconnected) => bail!("the server ended by itself"),
        }
    }
    bail!("the page took longer than {} s", PATIENCE.as_secs())
}

/// Serves files until it is ended.
pub(super) fn serve(folders: Folders, port: u16) -> anyhow::Result<()> {
    let listener = TcpListener::bind(("127.0.0.1", port))?;
    println!("http://127.0.0.1:{}/", listener.local_addr()?.port());
    listen(&listener, folders, &channel().0);
    Ok(())
}

/// A thread for each connection: browsers open some ahead and leave them alone.
fn listen(listener: &TcpListener, folders: Folders, sender: &Sender<Answer>) {
    let folders = Arc::new(folders);
    for stream in listener.incoming().flatten() {
        let (folders, sender) = (Arc::clone(&folders), sender.clone());
        thread::spawn(move || {
            if let Ok(Some(request)) = read(&stream) {
                match request {
                    Request::Get(path) => send(stream, file(&folders, &path)),
                    Request::Post(path, body) => {
                        send(stream, Some((Vec::new(), "text/plain")));
                        // Nobody waits for it any more.
                        let _ = sender.send((path, body));
                    }
                }
            }
        });
    }
}

/// Ends with its scope.
struct Browser(Child);

impl Drop for Browser {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

fn start(profile: &Path, address: &str) -> anyhow::Result<Child> {
    for program in PROGRAMS {
        let child = Command::new(program)
            .args([
                "--headless=new",
                "--no-sandbox",
                "--no-first-run",
                "--disable-extensions",
                "--enable-unsafe-webgpu",
                "--use-webgpu-adapter=swiftshader",
                // Without these flags a canvas crashes the browser's GPU process.
                "--enable-features=Vulkan",
                "--use-vulkan=swiftshader",
                "--use-angle=swiftshader",
            ])
            .arg(format!("--user-data-dir={}", profile.display()))
            .arg(address)
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn();
        if let Ok(child) = child {
            return Ok(child);
        }
    }
    bail!("no browser: none of {} can be run", PROGRAMS.join(", "))
}

enum Request {
    Get(String),
    Post(String, Vec<u8>),
}

fn read(stream: &TcpStream) -> anyhow::Result<Option<Request>> {
    let mut reader = BufReader::new(stream);
    let mut line = String::new();
    if reader.read_line(&mut line)? == 0 {
        return Ok(None);
    }
    let mut words = line.split_whitespace();
    let (method, path) = (words.next().unwrap_or(""), words.next().unwrap_or(""));
    let (is_post, path) = (
        method == "POST",
        path.split('?').next().unwrap_or("").to_owned(),
    );
    let mut length = 0;
    loop {
        let mut header = String::new();
        reader.read_line(&mut header)?;
        let header = header.trim().to_ascii_lowercase();
        if header.is_empty() {
            break;
        }
        if let Some(value) = header.strip_prefix("content-length:") {
            length = value.trim().parse()?;
        }
    }
    if !is_post {
        return Ok(Some(Request::Get(path)));
    }
    let mut body = vec![0; length];
    reader.read_exact(&mut body)?;
    Ok(Some(Request::Post(path, body)))
}

/// A file and its type; none where there is none.
fn file(folders: &Folders, path: &str) -> Option<(Vec<u8>, &'static str)> {
    if path.contains("..") {
        return None;
    }
    let path = if path.ends_with('/') {
        &format!("{path}index.html")
    } else {
        path
    };
    let (start, folder) = folders.iter().find(|(start, _)| path.starts_with(start))?;
    let bytes = std::fs::read(folder.join(&path[start.len()..])).ok()?;
    let kind = match path.rsplit('.').next() {
        Some("html") => "text/html; charset=utf-8",
        Some("js" | "mjs") => "text/javascript; charset=utf-8",
        Some("json") => "application/json",
        Some("csv" | "wgsl") => "text/plain; charset=utf-8",
        Some("wasm") => "application/wasm",
        _ => "application/octet-stream",
    };
    Some((bytes, kind))
}

fn send(mut stream: TcpStream, answer: Option<(Vec<u8>, &str)>) {
    let (status, bytes, kind) = match answer {
        Some((bytes, kind)) => ("200 OK", bytes, kind),
        None => ("404 Not Found", Vec::new(), "text/plain"),
    };
    let head = format!(
        "HTTP/1.1 {status}\r\nContent-Type: {kind}\r\nContent-Length: {}\r\nConnection: close\r\n\r\n",
        bytes.len()
    );
    // A browser may have gone.
    let _ = stream
        .write_all(head.as_bytes())
        .and_then(|()| stream.write_all(&bytes));
}
