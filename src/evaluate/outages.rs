//! Satellites of a setup that are out of service.

use super::Setup;
use crate::constellation::gnss::{GnssSatellite, System};
use crate::ephemeris::Ephemeris;
use crate::ephemeris::outages::{OutageError, SatelliteOutage, gnss_in_service, in_service};

impl Setup {
    /// With satellites out of service; those of no GNSS are of the constellations that are evaluated.
    ///
    /// # Errors
    /// If several GNSS have a satellite of a name.
    pub fn with_outages(self, outages: Vec<SatelliteOutage>) -> Result<Self, OutageError> {
        let names = self.gnss_names();
        for outage in &outages {
            let with = names.iter().filter(|(system, names)| {
                let mut names = names.iter();
                names.any(|name| outage.is_of_gnss(system, name))
            });
            let systems: Vec<String> = with.map(|(system, _)| system.clone()).collect();
            if systems.len() > 1 {
                return Err(OutageError::Ambiguous {
                    origin: outage.origin.clone(),
                    name: outage.satellite.clone(),
                    systems,
                });
            }
        }
        Ok(Self { outages, ..self })
    }

    /// The satellites of each GNSS that are in service at some time.
    #[must_use]
    pub fn gnss_in_service(&self) -> Vec<(&System, Vec<GnssSatellite>)> {
        let of_system = |system| {
            let all = System::satellites(system, self.grid.epoch());
            (system, gnss_in_service(system.name(), all, &self.outages))
        };
        self.gnss.iter().map(of_system).collect()
    }

    /// The satellites of a constellation that are in service at some time.
    ///
    /// # Errors
    /// If an outage is of no satellite of the constellation or the GNSS, or none is left.
    pub fn in_service(
        &self,
        constellation: &str,
        ephemeris: Ephemeris,
    ) -> Result<Ephemeris, OutageError> {
        in_service(constellation, ephemeris, &self.outages, &self.gnss_names())
    }

    /// Places of the satellites of a constellation that are out of service throughout.
    ///
    /// # Errors
    /// As [`Setup::in_service`].
    pub fn places_down(
        &self,
        constellation: &str,
        ephemeris: Ephemeris,
    ) -> Result<Vec<usize>, OutageError> {
        let names: Vec<String> = ephemeris
            .satellites()
            .iter()
            .map(|one| one.name.clone())
            .collect();
        let left = self.in_service(constellation, ephemeris)?;
        let mut left = left.satellites().iter().map(|one| &one.name).peekable();
        let is_down = |name: &String| left.next_if_eq(&name).is_none();
        let mut down = Vec::new();
        for (place, _) in names
            .iter()
            .map(is_down)
            .enumerate()
            .filter(|(_, down)| *down)
        {
            down.push(place);
        }
        Ok(down)
    }

    /// The first outage of no GNSS satellite.
    #[must_use]
    pub fn outage_of_constellation(&self) -> Option<&SatelliteOutage> {
        let names = self.gnss_names();
        let of_gnss = |outage: &SatelliteOutage| {
            names.iter().any(|(system, names)| {
                let mut names = names.iter();
                names.any(|name| outage.is_of_gnss(system, name))
            })
        };
        self.outages.iter().find(|outage| !of_gnss(outage))
    }

    /// The names of each GNSS and of its satellites, of use only if there are outages.
    fn gnss_names(&self) -> Vec<(String, Vec<String>)> {
        let of_system = |system: &System| {
            let satellites = system.satellites(self.grid.epoch()).into_iter();
            let names = satellites.map(|one| one.name).collect();
            (system.name().to_owned(), names)
        };
        self.gnss.iter().map(of_system).collect()
    }
}
