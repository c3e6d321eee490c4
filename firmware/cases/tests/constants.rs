//! A configuration that is a constant changes what a step costs, not what it does.

use bowden_cases::{run, Output, Signal};

fn outputs(name: &str) -> Vec<Output> {
    let mut all = Vec::new();
    for signal in Signal::ALL {
        let done = run(name, signal, &mut |output| all.push(output));
        assert_eq!(done, Some(Ok(())), "{name}");
    }
    all
}

#[test]
fn a_constant_configuration_gives_the_outputs_of_the_loaded_one() {
    for name in [
        "pi",
        "pid",
        "piv",
        "adaptive-2-lag-clamp",
        "adaptive-2-lag-tanh",
        "adaptive-2-literal-clamp",
        "adaptive-2-literal-tanh",
        "observer",
        "learning",
        "model-2",
        "model-8",
    ] {
        let (loaded, fixed) = (outputs(name), outputs(&format!("{name}-constant")));
        let bits = |all: &[Output]| -> Vec<_> {
            all.iter()
                .map(|it| (it.value.to_bits(), it.status))
                .collect()
        };
        assert!(bits(&loaded) == bits(&fixed), "{name}");
    }
}
