//! The reference Modbus server in Python answers our driver over a pair of ports by socat.

use std::env;
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::sync::Arc;
use std::thread;
use std::time::Duration;

use devices::clock::WallClock;
use devices::{Instrument, InstrumentEvent};

use crate::bench::{channels, device};
use crate::debian;

/// A pymodbus server at the port that the first argument names.
const SERVE: &str = r#"
import asyncio, sys
from pymodbus.server import ModbusSerialServer
from pymodbus.simulator import DataType, SimData, SimDevice

async def serve():
    data = [SimData(0, values=[12.345, -3.75], datatype=DataType.FLOAT32),
            SimData(4, values=[-1234], datatype=DataType.INT16)]
    device = SimDevice(1, simdata=data)
    server = ModbusSerialServer(device, port=sys.argv[1], baudrate=19200)
    print("serving", flush=True)
    await server.serve_forever()

asyncio.run(serve())
"#;

/// Two ports that socat joins byte for byte.
fn socat(ours: &Path, theirs: &Path) -> Running {
    let port = |path: &Path| format!("pty,rawer,link={}", path.display());
    let program = debian::program("socat", "socat");
    let socat = Command::new(program).args([port(ours), port(theirs)]).spawn().map(Running);
    let socat = socat.expect("socat runs");
    while !ours.exists() || !theirs.exists() {
        thread::sleep(Duration::from_millis(5));
    }
    socat
}

/// The interpreter of a virtual environment that has `pymodbus`; none without Python or network.
fn python() -> Option<PathBuf> {
    let home = Path::new(env!("CARGO_TARGET_TMPDIR")).join("python_pymodbus");
    let python = home.join("bin/python3");
    let run = |program: &Path, arguments: &[&str]| -> Result<(), String> {
        match Command::new(program).args(arguments).output() {
            Ok(Output { status, .. }) if status.success() => Ok(()),
            Ok(Output { stderr, .. }) => Err(String::from_utf8_lossy(&stderr).into_owned()),
            Err(error) => Err(error.to_string()),
        }
    };
    let import = ["-c", "import serial, pymodbus.simulator, pymodbus.server"];
    let made = run(&python, &import).or_else(|_| {
        run(Path::new("python3"), &["-m", "venv", &home.display().to_string()])?;
        run(&python, &["-m", "pip", "install", "--quiet", "pymodbus[serial]==3.16.1"])?;
        run(&python, &import)
    });
    match made {
        Ok(()) => Some(python),
        Err(error) if env::var_os("CI").is_none() => {
            eprintln!("skipped: no Python with pymodbus here: {error}");
            None
        }
        Err(error) => panic!("no Python with pymodbus: {error}"),
    }
}

/// A program that ends with the test.
struct Running(Child);

impl Drop for Running {
    fn drop(&mut self) {
        self.0.kill().ok();
        self.0.wait().ok();
    }
}

// One story, so that no two tests ever install into the same folder at once.
#[test]
fn registers_are_read_and_an_address_beyond_them_is_refused() {
    let Some(python) = python() else { return };
    let fields = r#"
        [settings]
        fields = [
            { function = 3, address = 0, type = "float32", order = "ABCD" },
            { function = 3, address = 2, type = "float32", order = "ABCD" },
            { function = 3, address = 4, type = "int16" },
            { function = 3, address = 900, type = "int16" },
        ]
    "#;
    let (folder, config) = device("modbus-transmitter", &format!("{fields}\n{}", channels(4)));
    let theirs = folder.path().join("theirs");
    let _pair = socat(&config.port, &theirs);
    let mut server = Command::new(python)
        .args(["-c", SERVE, &theirs.display().to_string()])
        .stdout(Stdio::piped())
        .spawn()
        .map(Running)
        .unwrap();
    let mut line = String::new();
    BufReader::new(server.0.stdout.take().unwrap()).read_line(&mut line).unwrap();
    assert_eq!(line.trim(), "serving");

    let mut instrument = Instrument::start(&config, Arc::new(WallClock::start())).unwrap();
    let (mut values, mut refused) = (Vec::new(), String::new());
    for _ in 0..2000 {
        let mut events = Vec::new();
        instrument.next(Duration::from_millis(5), &mut events);
        for event in events {
            match event {
                InstrumentEvent::Sample(measured) => values.push(measured.raw),
                InstrumentEvent::Trouble(error) => refused = error.to_string(),
                _ => {}
            }
        }
        if values.len() >= 300 && !refused.is_empty() {
            break;
        }
    }
    assert!(values.len() >= 300, "{} values; {refused}", values.len());
    let expected = [f64::from(12.345f32), -3.75, -1234.0];
    assert!(values.chunks_exact(3).all(|three| three == expected), "{values:?}");
    assert!(refused.contains("\"exception "), "{refused}");
    // A server in Python may be slow to answer on a busy machine, but nothing it says is damaged.
    let damaged: u64 = instrument.counts().map(|(_, counts)| counts.damaged).sum();
    assert_eq!(damaged, 0);
}
