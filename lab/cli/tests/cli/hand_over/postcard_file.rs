//! The bytes that firmware reads and their checksum, and the models in the repository.

use crate::hand_over::demo;
use crate::shell::{example, has, said, Folder};
use bowden::model::Model;
use bowden_lab::export::{postcard as bytes, ModelFile};
use std::path::Path;

#[allow(dead_code)]
#[path = "../../../../identify/examples/check_vector.rs"]
mod check_vector;
#[allow(dead_code)]
#[path = "../../../../../examples/feed_forward.rs"]
mod feed_forward;

const CRC: crc::Crc<u32> = crc::Crc::<u32>::new(&crc::CRC_32_ISO_HDLC);

/// A model with eight terms, three of them with two shapes: as large as the loop makes them.
fn eight_terms() -> ModelFile {
    let mut text = String::from(
        "schema = \"bowden.model/1\"\nmode = \"torque\"\nchannels = [\"phi_p\", \"phi_d\"]\n\
         [transmission]\ngain = 0.95\nkappa_eta = 2.29\noffset = 0.05\nrho = 0.382\nsigma = 0.5\nn = 1.02\n",
    );
    for (effect, source, shapes) in [
        ("viscous", "phi_p", &[][..]),
        ("coulomb", "phi_p", &[("v_e", 0.01)]),
        ("stribeck", "phi_p", &[("v_s", 0.3), ("a", 1.0)]),
        ("inertia", "phi_d", &[]),
        ("ripple", "phi_d", &[("k", 12.0), ("psi", 0.5)]),
        ("hinge", "phi_d", &[("x_h", 0.2)]),
        ("creep", "input", &[("tau", 1.5)]),
        ("load-friction", "phi_p", &[("v_e", 0.02)]),
    ] {
        let term = format!("effect = \"{effect}\"\nsource = \"{source}\"");
        text += &format!("[[terms]]\n{term}\norigin = 0.1234\ngain = -0.4321\n");
        for (name, value) in shapes {
            text += &format!("[[terms.shapes]]\nname = \"{name}\"\nvalue = {value:?}\n");
        }
    }
    toml::from_str(&text).unwrap()
}

fn read(bytes: &[u8]) -> Result<Model<f32, 8>, postcard::Error> {
    postcard::from_bytes_crc32(bytes, CRC.digest())
}

#[test]
fn eight_terms_take_at_most_160_bytes_and_read_back_to_the_same_model_unless_a_bit_has_flipped() {
    let file = eight_terms();
    let good = bytes(&file).unwrap();
    println!("postcard with CRC-32, eight terms: {} bytes", good.len());
    assert!(good.len() <= 160, "{} bytes", good.len());
    let model = read(&good).unwrap();
    assert_eq!(model, file.model_in::<f32, 8>().unwrap());
    assert_eq!(model.terms().len(), 8);
    for at in 0..good.len() {
        let mut bad = good.clone();
        bad[at] ^= 0x10;
        assert!(read(&bad).is_err(), "byte {at}");
    }
    assert!(read(&good[..good.len() - 1]).is_err());
}

#[test]
fn the_checksum_is_that_of_zlib() {
    let bytes = bytes(&eight_terms()).unwrap();
    let (body, check) = bytes.split_at(bytes.len() - 4);
    // Bit by bit, from the definition in RFC 1952, section 8.
    let crc = !body.iter().fold(!0_u32, |crc, byte| {
        (0..8).fold(crc ^ u32::from(*byte), |c, _| {
            (c >> 1) ^ (0xEDB8_8320 & (c & 1).wrapping_neg())
        })
    });
    assert_eq!(check, crc.to_le_bytes());
}

#[test]
fn the_program_writes_the_same_model_as_postcard_and_as_toml() {
    let folder = Folder::new();
    let path = folder.path("model.postcard");
    said(&format!("identify --model-out {path}"));
    let model = read(&std::fs::read(&path).unwrap()).unwrap();
    assert_eq!(model, demo(false).file.model_in::<f32, 8>().unwrap());
    assert_eq!(model.terms().len(), 1);
}

#[test]
fn the_demo_model_as_written_drives_the_compensator_of_the_example() {
    let (worst, most) = feed_forward::run(20.0).unwrap();
    // 16 roundings of f32 of the magnitudes in the equation, see `Inverse::step`: the
    // command, the hysteresis and the output together are below 40 N·m.
    assert!(worst < 16.0 * f32::EPSILON * 40.0, "{worst}");
    assert!(most > 6.5, "{most}");
}

#[test]
fn the_model_in_the_repository_is_one_model_in_three_forms_and_alone_gives_its_vector() {
    let toml = example("demo.toml");
    let toml = Path::new(&toml);
    for form in ["toml", "postcard"] {
        println!(
            "{}",
            check_vector::check(&toml.with_extension(form)).unwrap()
        );
    }
    let text = std::fs::read_to_string(toml).unwrap();
    let model: Model<f32, 1> = toml::from_str(&text).unwrap();
    assert_eq!(model, feed_forward::demo::model().unwrap());

    let folder = Folder::new();
    std::fs::copy(example("demo.vector.csv"), folder.path("demo.vector.csv")).unwrap();
    let line = text.lines().find(|l| l.starts_with("rho = ")).unwrap();
    let rho: f64 = line.trim_start_matches("rho = ").parse().unwrap();
    let check = |rho: f64| {
        let changed = text.replace(line, &format!("rho = {rho}"));
        check_vector::check(Path::new(&folder.file("demo.toml", changed)))
    };
    assert!(check(rho).is_ok());
    has(
        &check(1.001 * rho).unwrap_err().to_string(),
        &["does not give its vector"],
    );
}
