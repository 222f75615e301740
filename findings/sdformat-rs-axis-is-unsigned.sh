#!/bin/sh
# SPDX-License-Identifier: MIT
# An axis of a joint is three unsigned whole numbers for sdformat-rs: 0 0 -1 and 0 0 1.0 raise, and links have no
# names.
#
# Version:   sdformat-rs 0.1.0 (Rust).
# Expected:  An axis is a direction, so each of the three numbers may have a sign and a fraction. The joints name their
#           links.
# Behaviour: The axis is read as u32. A pose whose numbers are separated by a tab or a new line raises, too. A link is
#           read without its name, so nothing tells which one a joint means.
# Hurts:     Anyone who reads models of Gazebo in Rust: a wheel that turns the other way has 0 0 -1, exported models
#           have 0 0 1.0 or lines within a pose.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    mkdir src && touch src/main.rs && cat >Cargo.toml <<'END' && cargo fetch -q || return 1
[package]
name = "finding"
version = "0.1.0"
edition = "2021"

[dependencies]
sdformat-rs = "=0.1.0"
END
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >src/main.rs <<'END'
fn model(axis: &str, pose: &str) -> String {
    format!(
        "<?xml version='1.0'?><sdf version='1.6'><model name='robot'>
        <link name='base'><pose>{pose}</pose></link><link name='sonar'/>
        <joint name='turn' type='revolute'><parent>base</parent><child>sonar</child><axis><xyz>{axis}</xyz>
        <dynamics><damping>0</damping><friction>0</friction></dynamics>
        <use_parent_model_frame>false</use_parent_model_frame></axis></joint></model></sdf>"
    )
}

fn main() {
    for (axis, pose) in [
        ("0 0 1", "0 0 0.1 0 0 0"),
        ("0 0 -1", "0 0 0.1 0 0 0"),
        ("0 0 1.0", "0 0 0.1 0 0 0"),
        ("0 0 1", "0 0 0.1\t0 0 0"),
        ("0 0 1", "0 0 0.1\n0 0 0"),
    ] {
        let read = sdformat_rs::read_from_string(&model(axis, pose));
        let text = read.map(|models| models[0].joints[0].axis.xyz.value).map_err(|_| "raises");
        println!("axis {axis:?}, pose {pose:?}: {text:?}");
    }
    let read = sdformat_rs::read_from_string(&model("0 0 1", "0 0 0.1 0 0 0")).unwrap();
    let links = format!("{:?}", read[0].links);
    println!("links: {}, with the name sonar: {}", read[0].links.len(), links.contains("sonar"));
}
END
cargo run -q --offline >seen

cat >expected <<'END'
axis "0 0 1", pose "0 0 0.1 0 0 0": Ok([0, 0, 1])
axis "0 0 -1", pose "0 0 0.1 0 0 0": Err("raises")
axis "0 0 1.0", pose "0 0 0.1 0 0 0": Err("raises")
axis "0 0 1", pose "0 0 0.1\t0 0 0": Err("raises")
axis "0 0 1", pose "0 0 0.1\n0 0 0": Err("raises")
links: 2, with the name sonar: false
END
diff expected seen || { echo "CHANGED: sdformat-rs-axis-is-unsigned" >&2; exit 1; }
echo "PASS: 0 0 -1 is no axis"
