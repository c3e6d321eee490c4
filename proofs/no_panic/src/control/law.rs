//! `control/law.rs`

use crate::{any, never_panics};
use bowden::control::law;
use bowden::Real;

pub fn all<T: Real>() {
    never_panics!(control_law_error, law::error::<T>(any(), any()));
    never_panics!(control_law_z_increment, law::z_increment::<T>(any(), any()));
    never_panics!(
        control_law_filtered_error,
        law::filtered_error::<T>(any(), any(), any())
    );
    never_panics!(control_law_command, law::command::<T>(any(), any()));
    never_panics!(
        control_law_first_order_increment,
        law::first_order_increment::<T>(any(), any(), any())
    );
    never_panics!(
        control_law_plant_command,
        law::plant_command::<T>(any(), any(), any())
    );
    never_panics!(control_law_z_rate, law::z_rate::<T>(any(), any(), any()));
    never_panics!(control_law_s_rate, law::s_rate::<T>(any(), any(), any()));
    never_panics!(
        control_law_proportional,
        law::proportional::<T>(any(), any(), any())
    );
    never_panics!(
        control_law_damped,
        law::damped::<T>(any(), any(), any(), any())
    );
    never_panics!(
        control_law_first_order_damped,
        law::first_order_damped::<T>(any(), any(), any(), any())
    );
    never_panics!(
        control_law_virtual_command,
        law::virtual_command::<T>(any(), any(), any(), any())
    );
    never_panics!(
        control_law_beta_excitation,
        law::beta_excitation::<T>(any(), any())
    );
    never_panics!(
        control_law_delta_excitation,
        law::delta_excitation::<T>(any(), any())
    );
    never_panics!(
        control_law_theta_excitation,
        law::theta_excitation::<T>(any(), any())
    );
    never_panics!(
        control_law_estimate_increment,
        law::estimate_increment::<T>(any(), any(), any(), any(), any())
    );
    never_panics!(control_law_smooth_sign, law::smooth_sign::<T>(any()));
    never_panics!(control_law_clamped_sign, law::clamped_sign::<T>(any()));
}
