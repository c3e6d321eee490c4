//! The bytes that firmware reads, and their checksum.

use crate::shell::{said, Folder};
use bowden::model::Model;
use bowden_lab::export::{postcard as bytes, ModelFile, ShapeFile, TermFile, TransmissionFile};

const CRC: crc::Crc<u32> = crc::Crc::<u32>::new(&crc::CRC_32_ISO_HDLC);

/// A model with eight terms, two of them with two shapes: as large as the loop makes them.
fn eight_terms() -> ModelFile {
    let term = |effect: &str, source: &str, shapes: &[(&str, f64)]| TermFile {
        effect: effect.to_owned(),
        source: source.to_owned(),
        origin: 0.1234,
        gain: -0.4321,
        shapes: shapes
            .iter()
            .map(|(name, value)| ShapeFile {
                name: (*name).to_owned(),
                value: *value,
            })
            .collect(),
    };
    ModelFile {
        schema: "bowden.model/1".to_owned(),
        mode: "torque".to_owned(),
        channels: vec!["phi_p".to_owned(), "phi_d".to_owned()],
        transmission: Some(TransmissionFile {
            gain: 0.95,
            kappa_eta: 2.29,
            offset: 0.05,
            rho: 0.382,
            sigma: 0.5,
            n: 1.02,
        }),
        terms: vec![
            term("viscous", "phi_p", &[]),
            term("coulomb", "phi_p", &[("v_e", 0.01)]),
            term("stribeck", "phi_p", &[("v_s", 0.3), ("a", 1.0)]),
            term("inertia", "phi_d", &[]),
            term("ripple", "phi_d", &[("k", 12.0), ("psi", 0.5)]),
            term("hinge", "phi_d", &[("x_h", 0.2)]),
            term("creep", "input", &[("tau", 1.5)]),
            term("load-friction", "phi_p", &[("v_e", 0.02)]),
        ],
        about: None,
    }
}

#[test]
fn eight_terms_take_at_most_160_bytes_and_read_back_to_the_same_model() {
    let file = eight_terms();
    let bytes = bytes(&file).unwrap();
    println!("postcard with CRC-32, eight terms: {} bytes", bytes.len());
    assert!(bytes.len() <= 160, "{} bytes", bytes.len());
    let model: Model<f32, 8> = postcard::from_bytes_crc32(&bytes, CRC.digest()).unwrap();
    assert_eq!(model, file.model_in::<f32, 8>().unwrap());
    assert_eq!(model.terms().len(), 8);
}

#[test]
fn a_bit_that_has_flipped_anywhere_is_refused() {
    let good = bytes(&eight_terms()).unwrap();
    for at in 0..good.len() {
        let mut bad = good.clone();
        bad[at] ^= 0x10;
        let read = postcard::from_bytes_crc32::<Model<f32, 8>>(&bad, CRC.digest());
        assert!(read.is_err(), "byte {at}");
    }
    let short = &good[..good.len() - 1];
    assert!(postcard::from_bytes_crc32::<Model<f32, 8>>(short, CRC.digest()).is_err());
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
    let path = |name: &str| folder.path(name);
    let (toml, bytes) = (path("model.toml"), path("model.postcard"));
    said(&["identify", "--model-out", &toml]);
    said(&["identify", "--model-out", &bytes]);
    let file: ModelFile = toml::from_str(&std::fs::read_to_string(&toml).unwrap()).unwrap();
    let bytes = std::fs::read(&bytes).unwrap();
    let model: Model<f32, 8> = postcard::from_bytes_crc32(&bytes, CRC.digest()).unwrap();
    assert_eq!(model, file.model_in::<f32, 8>().unwrap());
    assert_eq!(model.terms().len(), 1);
}
